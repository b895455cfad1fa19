// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/open/off.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <functional>
#include <memory>

#include "base/system_error.hpp"
#include "device/open/open.hpp"
#include "device/os/clock.hpp"
#include "device/os/lock.hpp"
#include "device/os/process.hpp"
#include "device/port/find_ports.hpp"
#include "device/projector/display_backends.hpp"

namespace vam::device {

namespace {

constexpr double patience_s = 2;    // with a tool that was asked to end
constexpr double hidden_s = 1;      // with what holds a lock and cannot be seen
constexpr double attempts_s = 3;    // that begin
constexpr int silence_us = 300000;  // after which no reply to an earlier question comes
constexpr double stands_s = 2;      // after the order to
constexpr int limit_s = 6;          // of a device
constexpr double full_current_percent = 100;

void wait_a_moment() { usleep(10000); }

// One at a time: a second one would end the first in the middle of a command. One that hangs keeps nobody.
std::unique_ptr<DeviceLock> take_turn() {
  for (const double last_s = real_clock().now_s() + limit_s; real_clock().now_s() < last_s; wait_a_moment()) {
    try {
      return std::make_unique<DeviceLock>("off");
    } catch (const InUse&) {
      continue;
    } catch (const Error&) {  // no folder for locks: the devices say so
      break;
    }
  }
  return nullptr;
}

// Again and again, as who was killed may have left half a conversation, whose end comes in the next one. A guardian
// holds the lock until the device is safe: it hears no SIGTERM, and has the same time before it counts as frozen.
void insist(const std::function<void()>& act) {
  double begin_s = real_clock().now_s();
  int asked = 0;
  for (;; wait_a_moment()) {
    try {
      return act();
    } catch (const InUse& used) {
      if (used.holder != 0 && used.holder != asked) {
        asked = used.holder;
        kill(asked, SIGTERM);
        begin_s = real_clock().now_s();
      }
      const double spent_s = real_clock().now_s() - begin_s;
      if (used.holder != 0 && spent_s > patience_s) kill(asked, SIGKILL);
      if (spent_s > (asked != 0 ? attempts_s : hidden_s)) throw;
    } catch (const Error& error) {
      if (error.fault == Fault::absent || real_clock().now_s() - begin_s > attempts_s) throw;
      usleep(silence_us);
    }
  }
}

// One that stands is left alone: some stages lose their reference by an order to stop.
void stop(const std::string& device) {
  auto& clock = real_clock();
  const auto stage = open_stage(device, clock, nullptr);
  try {
    if (!stage->moving()) return;
  } catch (const Error& error) {  // it answers nobody, as one that searches its reference
    if (error.fault == Fault::absent) throw;
  }
  stage->stop(Stop::abrupt);
  for (const double last_s = clock.now_s() + stands_s; stage->moving(); wait_a_moment()) {
    if (clock.now_s() > last_s) throw Error{Fault::busy, device + ": does not stop"};
  }
}

// Its options may be wrong; standby needs none.
std::string without_options(const std::string& device) { return device.substr(0, device.find('?')); }

// Returns the state that the device is in.
std::string act_on(const Switched& one) {
  if (one.kind == "light") {
    open_light(without_options(one.device), full_current_percent, nullptr)->standby();
    return "in standby";
  }
  if (one.kind == "relay") {
    open_relay(one.device, nullptr)->force_open();
    return "open";
  }
  if (one.kind == "display") {  // its image goes with the tool
    const DeviceLock ours(one.device);
    return "dark";
  }
  stop(one.device);
  return "stopped";
}

// In the child. Its one word: the fault, or 0 and the state.
[[noreturn]] void tell(int pipe, const Switched& one) {
  std::string word;
  alarm(limit_s);
  hurry(Urgency::driver);
  try {
    insist([&] { word = '\0' + act_on(one); });
  } catch (const Error& error) {
    word = static_cast<char>(error.fault) + std::string(error.what());
  } catch (const std::exception& error) {
    word = static_cast<char>(Fault::bug) + std::string(error.what());
  }
  (void)!write(pipe, word.data(), word.size());
  _exit(0);
}

struct Child {
  int pid = -1;
  int pipe = -1;
};

Child begin(const Switched& one) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw system_error(Fault::memory, "no pipe", errno, "raise the limit (ulimit -n)");
  const pid_t pid = fork();
  if (pid < 0) throw system_error(Fault::memory, "cannot fork", errno, "raise the limit on processes (ulimit -u)");
  if (pid == 0) tell(ends[1], one);
  close(ends[1]);
  return {pid, ends[0]};
}

std::string word_of(int pipe, double deadline_s) {
  std::string word;
  std::array<char, 4096> bytes{};
  for (;;) {
    const double left_s = deadline_s - real_clock().now_s();
    pollfd readable{pipe, POLLIN, 0};
    if (left_s <= 0 || poll(&readable, 1, static_cast<int>(1000 * left_s) + 1) <= 0) return word;
    const ssize_t size = read(pipe, bytes.data(), bytes.size());
    if (size <= 0) return word;
    word.append(bytes.data(), static_cast<std::size_t>(size));
  }
}

// One that hangs in the system does not even die: it is not waited for.
void end(Switched& one, const Child& child, double deadline_s) {
  const std::string word = word_of(child.pipe, deadline_s);
  close(child.pipe);
  kill(child.pid, SIGKILL);
  waitpid(child.pid, nullptr, WNOHANG);
  if (word.empty()) {
    const bool late = real_clock().now_s() >= deadline_s;
    one.problem = one.device + (late ? ": no end of it within 6 s" : ": what switches it off was killed; try again");
  } else if (word.front() == '\0') {
    one.state = word.substr(1);
  } else {
    one.fault = static_cast<Fault>(word.front());
    one.problem = word.substr(1);
  }
}

bool ends_with_its_tool(const Switched& one) { return one.device.starts_with("sim:"); }

}  // namespace

std::vector<Switched> find_lit() {
  std::vector<Switched> lit;
  for (const DeviceListing& found : find_usb_devices()) {
    if (found.kind == "light") lit.push_back({found.kind, found.device});
  }
  for (const char* kind : {drm_lock, sdl_lock}) {
    for (const std::string& name : locked_names(kind)) lit.push_back({"display", name});
  }
  return lit;
}

void switch_off(std::vector<Switched>& devices) {
  const auto turn = take_turn();
  const double deadline_s = real_clock().now_s() + limit_s;
  std::vector<Child> children;
  for (Switched& one : devices) {
    try {
      children.push_back(ends_with_its_tool(one) ? Child{} : begin(one));
    } catch (const Error& error) {
      children.push_back({});
      one.problem = error.what();
      one.fault = error.fault;
    }
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (children[i].pid > 0) {
      end(devices[i], children[i], deadline_s);
    } else if (devices[i].problem.empty()) {
      devices[i].state = "simulated: ends with its tool";
    }
  }
}

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/controllers/pty_host.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/inotify.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <map>

#include "base/error.hpp"
#include "device/os/clock.hpp"
#include "device/os/interrupt.hpp"

namespace vam::sim {

namespace {

constexpr double tick_s = 0.002;  // how late a change of motion may be written down

// What a receiver at the wrong rate makes of the bytes.
std::string garbled(std::string bytes) {
  for (char& c : bytes) c = static_cast<char>((static_cast<unsigned char>(c) * 37U + 11U) & 0xFFU);
  return bytes;
}

}  // namespace

Pty::Pty() {
  master_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  std::array<char, 128> name{};
  if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 ||
      ptsname_r(master_, name.data(), name.size()) != 0) {
    throw Error{Fault::absent, std::string("no pseudo-terminal available (") + std::strerror(errno) + ")"};
  }
  path_ = name.data();
  slave_ = open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios settings{};
  tcgetattr(slave_, &settings);
  cfmakeraw(&settings);
  tcsetattr(slave_, TCSANOW, &settings);
  fcntl(master_, F_SETFL, O_NONBLOCK);
  opens_ = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (opens_ < 0 || inotify_add_watch(opens_, name.data(), IN_OPEN) < 0) {
    throw Error{Fault::absent, path_ + ": cannot be watched (" + std::strerror(errno) + ")"};
  }
}

Pty::~Pty() {
  unplug();
  if (opens_ >= 0) close(opens_);
}

bool Pty::take_opened() {
  std::array<char, 4096> events{};
  bool opened = false;
  while (read(opens_, events.data(), events.size()) > 0) opened = true;
  return opened;
}

void Pty::unplug() {
  if (master_ >= 0) close(master_);
  if (slave_ >= 0) close(slave_);
  master_ = slave_ = -1;
}

int Pty::baud() const {
  static const std::map<speed_t, int> rates{{B9600, 9600}, {B19200, 19200}, {B38400, 38400}, {B115200, 115200}};
  termios settings{};
  tcgetattr(slave_, &settings);
  const auto found = rates.find(cfgetospeed(&settings));
  return found == rates.end() ? 0 : found->second;
}

void serve(Pty& pty, SimDevice& device, std::optional<int> baud) {
  auto& clock = device::real_clock();
  for (;;) {
    device::check_interrupted();
    double wait_s = tick_s;
    if (const auto due_s = device.next_due_s()) wait_s = std::clamp(*due_s - clock.now_s(), 0.0, tick_s);
    const timespec wait{0, static_cast<long>(wait_s * 1e9)};
    std::array<pollfd, 2> watched{pollfd{pty.master(), POLLIN, 0}, pollfd{device::interrupt_fd(), POLLIN, 0}};
    ppoll(watched.data(), watched.size(), &wait, nullptr);
    const bool right_rate = !baud || pty.master() < 0 || pty.baud() == *baud;
    if ((watched[0].revents & POLLIN) != 0) {
      std::array<char, 4096> bytes{};
      const ssize_t count = read(pty.master(), bytes.data(), bytes.size());
      // After the bytes were read: a user opens before he writes.
      if (pty.take_opened()) device.opened(clock.now_s());
      if (count > 0) {
        const std::string text(bytes.data(), count);
        device.receive(right_rate ? text : garbled(text), clock.now_s());
      }
    }
    device.advance(clock.now_s());
    if (device.unplugged()) pty.unplug();
    const std::string answer = device.take(clock.now_s());
    if (answer.empty() || pty.master() < 0) continue;
    const std::string sent = right_rate ? answer : garbled(answer);
    if (write(pty.master(), sent.data(), sent.size()) < 0) continue;  // no reader: a serial line drops bytes, too
  }
}

}  // namespace vam::sim

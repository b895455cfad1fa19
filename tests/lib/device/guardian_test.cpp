// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/safety/guardian.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "base/text/json.hpp"
#include "device/os/clock.hpp"
#include "device/safety/guardian_actions.hpp"
#include "device/safety/stop_order.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;

namespace {

struct Outcome {
  std::string bytes;   // what reached the device
  double seconds = 0;  // from the cause to the last byte
};

// A tool in a child process: its guardian holds orders for a pipe that stands for the device; then `cause` ends it.
// `cause` receives the guardian and runs in the tool; `outside` receives the tool's pid and runs in the test.
Outcome outcome(const std::function<void(Guardian&, int)>& cause, const std::function<void(pid_t)>& outside = {}) {
  std::array<int, 2> line{};
  std::array<int, 2> ready{};
  REQUIRE(pipe(line.data()) == 0);
  REQUIRE(pipe(ready.data()) == 0);
  const pid_t tool = fork();
  if (tool == 0) {
    close(line[0]);
    dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
    for (const int signal : {SIGSEGV, SIGABRT, SIGINT, SIGTERM, SIGBUS, SIGFPE, SIGILL})
      std::signal(signal, SIG_DFL);  // doctest catches them
    {
      Guardian guardian(0.3);
      guardian.add({{"do", "write"}, {"order", 1}, {"hex", to_hex("still\n")}}, line[1]);
      guardian.add({{"do", "write"}, {"order", 0}, {"hex", to_hex("dark\n")}}, line[1]);
      (void)!write(ready[1], "x", 1);
      if (cause) cause(guardian, line[1]);
      if (outside) pause();
    }
    _exit(0);
  }
  close(line[1]);
  char byte = 0;
  REQUIRE(read(ready[0], &byte, 1) == 1);
  const double start_s = real_clock().now_s();
  if (outside) outside(tool);
  Outcome result;
  std::array<char, 100> bytes{};
  pollfd readable{line[0], POLLIN, 0};
  while (poll(&readable, 1, 3000) > 0) {
    const ssize_t count = read(line[0], bytes.data(), bytes.size());
    if (count <= 0) break;
    result.bytes.append(bytes.data(), static_cast<std::size_t>(count));
    result.seconds = real_clock().now_s() - start_s;
  }
  kill(tool, SIGKILL);
  waitpid(tool, nullptr, 0);
  for (const int end : {line[0], ready[0], ready[1]}) close(end);
  return result;
}

}  // namespace

TEST_CASE("However the tool ends, the light is off first, then the stage stops, within 100 ms") {
  for (const int signal : {SIGKILL, SIGSEGV, SIGABRT, SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGBUS}) {
    CAPTURE(signal);
    const Outcome result = outcome({}, [signal](pid_t tool) { kill(tool, signal); });
    CHECK(result.bytes == "dark\nstill\n");
    CHECK(result.seconds < 0.1);
  }
}

TEST_CASE("A tool that throws, returns or leaves by _exit has the same end") {
  CHECK(outcome([](Guardian&, int) {}).bytes == "dark\nstill\n");
  CHECK(outcome([](Guardian&, int) { _exit(3); }).bytes == "dark\nstill\n");
}

TEST_CASE("A tool that hangs is killed and made safe; one with a heartbeat is not") {
  const Outcome stopped = outcome({}, [](pid_t tool) { kill(tool, SIGSTOP); });
  CHECK(stopped.bytes == "dark\nstill\n");
  CHECK(stopped.seconds > 0.25);
  CHECK(stopped.seconds < 0.4);
  const Outcome beating = outcome([](Guardian& guardian, int device) {
    for (int i = 0; i < 12; ++i) {
      usleep(50000);
      guardian.beat();
    }
    (void)!write(device, "alive ", 6);
  });
  CHECK(beating.bytes == "alive dark\nstill\n");
}

TEST_CASE("A device in its safe state is not touched") {
  const Outcome result = outcome([](Guardian& guardian, int) {
    guardian.forget(1);
    guardian.forget(2);
  });
  CHECK(result.bytes.empty());
}

TEST_CASE("Without registered actions no heartbeat is needed") {
  const Outcome result = outcome([](Guardian& guardian, int device) {
    guardian.forget(1);
    guardian.forget(2);
    usleep(500000);
    (void)!write(device, "alive", 5);
  });
  CHECK(result.bytes == "alive");
}

TEST_CASE(
    "For a stage without a handle, which ends with the tool, the guardian has no order and asks for no heartbeat") {
  const Outcome result = outcome([](Guardian& guardian, int device) {
    guardian.forget(1);
    guardian.forget(2);
    StopOrder order(&guardian);
    order.give(std::string("halt\n"), -1);
    usleep(500000);
    const std::string said = order.standing() ? "alive" : "no order";
    (void)!write(device, said.data(), said.size());
  });
  CHECK(result.bytes == "alive");
}

TEST_CASE("A tool detects that its guardian is gone") {
  const Outcome result = outcome([](Guardian& guardian, int device) {
    kill(guardian.pid(), SIGKILL);
    usleep(20000);
    try {
      guardian.beat();
    } catch (const std::exception&) {
      (void)!write(device, "noticed", 7);
    }
    _exit(0);
  });
  CHECK(result.bytes == "noticed");
}

TEST_CASE("A guardian has a name of its own, so that who kills its tool by name or command line spares it") {
  const Guardian guardian;
  const auto file = [&](const char* name) {
    std::ifstream read("/proc/" + std::to_string(guardian.pid()) + "/" + name);
    return std::string{std::istreambuf_iterator<char>(read), {}};
  };
  for (int look = 0; look < 500 && !file("cmdline").starts_with("vam-guardian"); ++look) usleep(2000);
  CHECK(file("comm") == "vam-guardian\n");
  const std::string line = file("cmdline");
  CHECK(line.find_last_not_of('\0') + 1 == std::string("vam-guardian").size());
  CHECK(line.starts_with("vam-guardian"));
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/interrupt.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>

namespace vam::device {

namespace {

// One per process, like the signals themselves.
std::atomic<int> noted{0};         // NOLINT
std::array<int, 2> waker{-1, -1};  // NOLINT: a pipe; its read end wakes poll()
constexpr std::array caught{SIGINT, SIGTERM, SIGHUP};

extern "C" void note(int signal) {
  noted = signal;
  const char byte = 0;
  if (write(waker[1], &byte, 1) < 0) {
    // The pipe is full, so it is readable already: nothing is lost.
  }
}

void set_handlers(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  for (const int signal : caught) sigaction(signal, &action, nullptr);
}

}  // namespace

int interrupt_fd() { return waker[0]; }

bool interrupted() { return noted != 0; }

void check_interrupted() {
  const int signal = noted.exchange(0);
  if (signal == 0) return;
  char byte = 0;
  while (read(waker[0], &byte, 1) > 0) continue;
  set_handlers(SIG_IGN);  // from here the safe state has the word; the guardian bounds its time
  throw Interrupted{signal};
}

void end_with_parent() {
  const pid_t parent = getppid();
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent || parent == 1) raise(SIGTERM);  // it ended before this call
}

void interruptible(const std::function<void()>& body) {
  if (waker[0] < 0 && pipe2(waker.data(), O_CLOEXEC | O_NONBLOCK) != 0) waker = {-1, -1};
  set_handlers(note);
  int signal = 0;
  try {
    body();
    signal = noted;  // came after the last wait: the work is done and safe, but the caller requested an end
  } catch (const Interrupted& interrupted) {
    signal = interrupted.signal;
  }
  set_handlers(SIG_DFL);
  if (signal == 0) return;
  std::fflush(stdout);
  raise(signal);
}

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// SIGINT, SIGTERM and SIGHUP become an exception at the next wait, so that destructors establish the safe state; the
// process is then terminated by the same signal. This handles the orderly case; the guardian handles all others.
#pragma once

#include <functional>

namespace vam::device {

/// Not an Error: it has no message and no fault. Caught by interruptible() only.
struct Interrupted {
  int signal;
};

/// Runs body with the three signals noted instead of obeyed. When one came, and the stack is unwound, the process dies
/// of it (a shell sees 130 or 143). Errors pass through.
void interruptible(const std::function<void()>& body);

/// A signal is noted and check_interrupted() has not thrown yet.
[[nodiscard]] bool interrupted();

/// Throws Interrupted once after a signal; later calls do nothing, so that the way to the safe state is not cut short.
void check_interrupted();

/// From now on SIGTERM comes when the process that started this one ends, however it ends.
void end_with_parent();

/// Readable once a signal is noted and until check_interrupted() has thrown; -1 outside interruptible(). For poll().
[[nodiscard]] int interrupt_fd();

}  // namespace vam::device

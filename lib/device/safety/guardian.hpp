// SPDX-License-Identifier: GPL-3.0-or-later
// The guardian: a child process that brings the devices into their safe state when the tool cannot do so itself.
// It watches a socket for its end, which the kernel delivers whatever the tool dies of, SIGKILL included, and for
// heartbeats, which stop when the tool hangs. No part of safety depends on a signal handler [devices §7].
#pragma once

#include <string>

#include "base/text/json_fwd.hpp"

namespace vam::device {

/// Make it before any thread, window or device of the tool: it forks. The child is called vam-guardian. While at least
/// one action is registered, beat() must be called at least every stall_s; otherwise the guardian kills the tool
/// (SIGKILL) and acts. When the tool ends with actions still registered, the guardian carries them out in ascending
/// `order` (dark before still), at once. Without registered actions it exits silently. One line on stderr reports what
/// it did when the tool could not.
class Guardian {
 public:
  explicit Guardian(double stall_s = 0.5);
  /// Carries out what is still registered and waits until it is done, at most a second.
  ~Guardian();
  Guardian(const Guardian&) = delete;
  Guardian& operator=(const Guardian&) = delete;

  /// Registers an action and returns its number. handle, when not -1, is a file descriptor that the guardian gets a
  /// copy of. What `action` may say is listed in guardian_actions.hpp.
  int add(const Json& action, int handle = -1);
  /// The device is safe: its action is not needed any more.
  void forget(int id);
  /// The guardian keeps this descriptor (a lock) open until it ends.
  void keep(int handle);
  /// The tool is alive and its devices answer. Throws Fault::bug when the guardian itself is gone.
  void beat();
  [[nodiscard]] int pid() const { return child_; }

 private:
  void send(char kind, int id, const std::string& text, int handle);
  int socket_ = -1;
  int child_ = -1;
  int next_id_ = 1;
};

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// A dead-man relay on the lamp's power: it stays closed while it hears a heartbeat [devices §7].
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/text/json_fwd.hpp"
#include "device/os/clock.hpp"
#include "device/os/lock.hpp"
#include "device/port/port.hpp"
#include "device/safety/guardian.hpp"

namespace vam::device {

/// Asks the relay who it is, for at most 3 s, since many boards are reset when their port is opened. Throws Error: busy
/// (no answer), protocol (another device, or a time without heartbeat beyond 150 to 1000 ms), absent (unplugged).
class Relay {
 public:
  Relay(std::unique_ptr<Port> port, Clock& clock, Guardian* guardian);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  /// maker, model, and limit_ms: how long after the last heartbeat it opens.
  [[nodiscard]] Json identify() const;
  /// Closes it, and has the guardian open it should the tool end. Throws when it does not say that it is closed.
  void close();
  /// To be called at every step of the print: sends a heartbeat each 50 ms and looks at the answers without waiting.
  /// Throws Fault::protocol when it has opened, Fault::busy when it has not answered for as long as it waits.
  void beat();
  /// Has it open, without waiting for its reply; no heartbeat follows.
  void cut();
  /// cut(), then waits for the reply. Throws Fault::busy when there is none; the guardian keeps its order then.
  void open();
  /// open() for who has not closed it.
  void force_open();

  void hold(std::unique_ptr<DeviceLock> lock) { lock_ = std::move(lock); }

 private:
  [[nodiscard]] std::string answer(double timeout_s);  // a line, "" when none is complete in time
  std::unique_ptr<Port> port_;
  Clock& clock_;
  Guardian* guardian_;
  std::unique_ptr<DeviceLock> lock_;
  std::string buffer_;
  double limit_s_ = 0;
  double sent_s_ = 0;
  double answered_s_ = 0;
  bool simulated_ = false;
  bool closed_ = false;
  bool opening_ = false;  // told so, and has not replied
  std::optional<int> action_;
};

}  // namespace vam::device

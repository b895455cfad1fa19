// SPDX-License-Identifier: GPL-3.0-or-later
// A line of bytes to a device, with a deadline on everything.
#pragma once

#include <string>
#include <string_view>

namespace vam::device {

/// One class per way to reach a device: a serial port, or a simulator in the same process. Waits end early with
/// Interrupted when a signal asks the tool to end.
class Port {
 public:
  virtual ~Port() = default;
  /// Throws Fault::busy when the line does not take the bytes in time (at most 0.5 s), Fault::absent when unplugged.
  virtual void write(std::string_view bytes) = 0;
  /// Waits for at least one byte; "" when timeout_s passes first. Throws Fault::absent when unplugged.
  virtual std::string read(double timeout_s) = 0;
  /// For messages: "/dev/ttyUSB0".
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// The descriptor a guardian may write to; -1 when there is none.
  [[nodiscard]] virtual int handle() const { return -1; }
};

}  // namespace vam::device

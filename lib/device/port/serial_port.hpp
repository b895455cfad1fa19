// SPDX-License-Identifier: GPL-3.0-or-later
// Serial ports by libserialport, its pitfalls handled.
#pragma once

#include <memory>
#include <string>

#include "base/text/json_fwd.hpp"
#include "device/port/port.hpp"

namespace vam::device {

/// Opens a port with 8 data bits, no parity, 1 stop bit and no flow control, for this process only (TIOCEXCL; the lock
/// is DeviceLock's). Throws Fault::absent (no such port, or it refuses), Fault::busy (another program has it),
/// Fault::usage (a baud rate it cannot do).
[[nodiscard]] std::unique_ptr<Port> open_serial(const std::string& path, int baud);

/// The serial ports of this machine, for people and scripts: path, description, USB ids, serial number.
[[nodiscard]] Json list_serial_ports();

}  // namespace vam::device

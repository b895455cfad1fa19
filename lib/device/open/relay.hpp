// SPDX-License-Identifier: GPL-3.0-or-later
// Which dead-man relay a device string names.
#pragma once

#include <memory>
#include <string>

#include "device/safety/relay.hpp"

namespace vam::device {

/// relay:PATH with option baud (115200), or sim:, a simulated one. Null for an empty string: the printer has none.
[[nodiscard]] std::unique_ptr<Relay> open_relay(const std::string& device, Guardian* guardian);

}  // namespace vam::device

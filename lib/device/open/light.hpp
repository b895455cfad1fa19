// SPDX-License-Identifier: GPL-3.0-or-later
// Which light engine a device string names.
#pragma once

#include "device/projector/light_engine.hpp"

namespace vam::device {

/// dlpc350:SERIAL or dlpc900:SERIAL (serial optional) with options current_percent, max_current_percent and leds; sim:
/// is a simulated DLPC350. max_current_percent is the instrument's cap, which the option of that name can only lower.
[[nodiscard]] std::unique_ptr<LightEngine> open_light(const std::string& device, double max_current_percent,
                                                      Guardian* guardian);

/// The devices that open_light knows, for --help: "dlpc350:SERIAL, dlpc900:SERIAL or sim:".
[[nodiscard]] std::string light_devices();

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// The devices of this machine, each with the string that opens it.
#pragma once

#include <string>
#include <vector>

#include "device/os/device_listing.hpp"

namespace vam::device {

/// Stages, cameras, displays and light engines; nothing moves, shines or receives a command. `ports` are serial ports
/// besides those that the system lists.
[[nodiscard]] std::vector<DeviceListing> find_devices(const std::vector<std::string>& ports);

/// Asks who is at the other end of a serial port, protocol by protocol, and completes what is known of the stage: its
/// device string, maker, model and serial number, or that nobody answers. Some 4 s a port at most; a stage does not
/// move, but a board that is reset when its port is opened loses its position.
void ask_stage(DeviceListing& stage);

}  // namespace vam::device

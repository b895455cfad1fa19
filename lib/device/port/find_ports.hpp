// SPDX-License-Identifier: GPL-3.0-or-later
// Stages and light engines on serial ports and on USB, without sending commands.
#pragma once

#include <string>
#include <vector>

#include "device/os/device_listing.hpp"

namespace vam::device {

/// The serial ports of this machine, each as the stage that its USB identity speaks for (gcs: where none does), and
/// those of `ports` besides.
[[nodiscard]] std::vector<DeviceListing> find_serial_stages(const std::vector<std::string>& ports);

/// Tic stages, DLPC light engines, and USB3 Vision cameras that this user may not open and a camera library therefore
/// does not see.
[[nodiscard]] std::vector<DeviceListing> find_usb_devices();

}  // namespace vam::device

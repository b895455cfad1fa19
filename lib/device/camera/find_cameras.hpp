// SPDX-License-Identifier: GPL-3.0-or-later
// The cameras that this machine sees.
#pragma once

#include <vector>

#include "device/os/device_listing.hpp"

namespace vam::device {

/// GenICam cameras on USB3 Vision and GigE Vision (Aravis asks the network for a second at most), by address on a
/// network, else by their name there; and Video4Linux cameras.
[[nodiscard]] std::vector<DeviceListing> find_cameras();

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// The screens that frames can be shown on.
#pragma once

#include <vector>

#include "device/os/device_listing.hpp"

namespace vam::device {

/// The connectors of the graphics cards that have a screen, and the screens of the desktop, if there is one. Nothing is
/// shown on them.
[[nodiscard]] std::vector<DeviceListing> find_displays();

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// The constructors behind open_display(), and the screens that there are. A screen has its own mode; `wanted` is what
// null: plays.
#pragma once

#include <vector>

#include "device/os/device_listing.hpp"
#include "device/projector/display.hpp"

namespace vam::device {

/// How the names begin by which displays are locked.
inline constexpr const char* drm_lock = "drm-";
inline constexpr const char* sdl_lock = "sdl-";

[[nodiscard]] std::unique_ptr<Display> open_sdl_display(const Address& address, const DisplayMode& wanted, Clock& clock,
                                                        Guardian* guardian);
[[nodiscard]] std::unique_ptr<Display> open_drm_display(const Address& address, const DisplayMode& wanted, Clock& clock,
                                                        Guardian* guardian);
/// Options hz, and miss=N: every N-th flip comes one vertical blank late.
[[nodiscard]] std::unique_ptr<Display> open_null_display(const Address& address, const DisplayMode& wanted,
                                                         Clock& clock, Guardian* guardian);

/// The connectors of the graphics cards that have a screen, and the screens of the desktop, if there is one. Nothing is
/// shown on them.
[[nodiscard]] std::vector<DeviceListing> find_displays();

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// The constructors behind open_display(). A screen has its own mode; `wanted` is what null: plays.
#pragma once

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

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// Which display a device string names.
#pragma once

#include "device/projector/display.hpp"

namespace vam::device {

/// sdl:N (window over screen N), drm:CONNECTOR (page flips without a desktop), null: (nothing is shown; vertical blanks
/// by the clock). guardian may be null in tests. Throws as the constructors and DeviceLock do, and Fault::usage for a
/// bad device string.
[[nodiscard]] std::unique_ptr<Display> open_display(const std::string& device, const DisplayMode& wanted, Clock& clock,
                                                    Guardian* guardian);

/// The displays that open_display knows, for --help: "drm:CONNECTOR, sdl:SCREEN or null:".
[[nodiscard]] std::string display_devices();

/// Does this output name a display?
[[nodiscard]] bool names_display(const std::string& output);

}  // namespace vam::device

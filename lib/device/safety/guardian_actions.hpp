// SPDX-License-Identifier: GPL-3.0-or-later
// What a guardian can do to a device. An action is JSON, so that it travels through a socket:
//   {"do": "write", "order": 1, "hex": "18"}   writes the bytes to the handle that came with it, after throwing away
//                                              what the dead tool had queued there
//   {"do": "usb", "order": 1, "usb_id": "1ffb:00b3", "serial": "0031", "interface": -1,
//    "control": [[137, 0, 0]], "reports": ["..."]}   sends vendor requests (request, value, index), then HID reports
//    (hex)
//   {"do": "drm", "order": 0, "crtc": 7, "framebuffer": 3}   flips the card behind the handle to that (black) image
//   {"do": "nothing"}                          for a window, which goes with its tool: only hanging must be noticed
// `order`: 0 for light, 1 for motion; lower first.
#pragma once

#include <string>

#include "base/text/json_fwd.hpp"

namespace vam::device {

/// Carries one action out; never throws, never blocks longer than about 100 ms. False when the device did not take it.
bool carry_out(const Json& action, int handle);

[[nodiscard]] std::string to_hex(const std::string& bytes);
[[nodiscard]] std::string from_hex(const std::string& hex);

}  // namespace vam::device

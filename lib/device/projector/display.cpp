// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/projector/display.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "device/projector/display_backends.hpp"

namespace vam::device {

std::vector<std::uint8_t> screen_bytes(const GreyImage& levels, const DisplayMode& mode) {
  if (levels.width != mode.columns || levels.height != mode.rows) {
    throw Error{Fault::data, "frames of " + std::to_string(levels.width) + " x " + std::to_string(levels.height) +
                                 " pixels do not match the screen of " + std::to_string(mode.columns) + " x " +
                                 std::to_string(mode.rows) + "; set projector.columns and rows, or the screen's mode"};
  }
  if (levels.bits > 8) {
    throw Error{Fault::usage, "a screen has 8 bits per pixel, not " + std::to_string(levels.bits) + "; give --bits 8"};
  }
  std::vector<std::uint8_t> bytes(levels.values.size());
  std::transform(levels.values.begin(), levels.values.end(), bytes.begin(),
                 [&](std::uint16_t level) { return static_cast<std::uint8_t>(level * 255 / levels.full()); });
  return bytes;
}

}  // namespace vam::device

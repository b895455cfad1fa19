// SPDX-License-Identifier: GPL-3.0-or-later
// The pixel formats of a Video4Linux camera that hold grey levels.
#pragma once

#include <cstddef>
#include <string>

#include "device/camera/camera.hpp"
#include "device/camera/private/grey_pixels.hpp"
#include "device/camera/private/v4l2_node.hpp"

namespace vam::device {

struct V4l2Format {
  PixelLayout layout = PixelLayout::bytes;
  int bits = 8;
  std::size_t stride = 0;      // bytes a row
  bool limited_range = false;  // widen_luma()
};

/// Sets the format of that name, or the first of grey levels where it is empty; size and bits go into the mode. Throws
/// Fault::usage when the camera does not have it, protocol when it does not take it. Warns of a depth that is not
/// known.
[[nodiscard]] V4l2Format choose_format(const V4l2Node& node, const std::string& wanted, CameraMode& mode);

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// A video node by its path: what it is asked, and what a refusal means; its pixel format, and what decides how it makes
// grey levels of light, all read back.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <string>

#include "base/error.hpp"
#include "device/camera/camera.hpp"
#include "device/camera/private/grey_pixels.hpp"
#include "device/camera/v4l2_driver.hpp"

namespace vam::device {

template <class Struct>
Struct cleared() {
  Struct value;
  std::memset(&value, 0, sizeof value);
  return value;
}

struct V4l2Node {
  std::string path;
  std::unique_ptr<V4l2Driver> driver;

  [[nodiscard]] Error gone() const;
  /// By errno: absent when the camera is gone, else busy or protocol, "PATH: `what` (errno)".
  [[nodiscard]] Error refusal(const std::string& what) const;
  /// Throws refusal().
  void ask(unsigned long request, void* argument, const std::string& what) const;
};

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

/// Switches off every automatic that the camera has, then sets gamma, gain, black level, exposure and frame rate, and
/// reads all of them back into the mode. Throws Fault::protocol for a value that does not read back, Fault::usage for
/// one that the camera has no setting for.
void set_controls(const V4l2Node& node, const CameraSettings& settings, CameraMode& mode);

}  // namespace vam::device

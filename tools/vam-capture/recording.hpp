// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded frames for replay: cameras.
#pragma once

#include <string>

#include "device/camera/camera.hpp"

namespace vam::capture_tool {

/// A folder of vam-capture, a folder of numbered images, or an EXR frame stack. Values of a stack are fractions of
/// full scale, and become 16-bit levels unless all are whole 255ths. Throws as the readers do.
[[nodiscard]] device::CameraFeed open_recording(const std::string& place);

}  // namespace vam::capture_tool

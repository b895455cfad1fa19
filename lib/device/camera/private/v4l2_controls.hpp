// SPDX-License-Identifier: GPL-3.0-or-later
// What decides how a Video4Linux camera makes grey levels of light: levels, exposure and rate, all read back.
#pragma once

#include "device/camera/camera.hpp"
#include "device/camera/private/v4l2_node.hpp"

namespace vam::device {

/// Switches off every automatic that the camera has, then sets gamma, gain, black level, exposure and frame rate, and
/// reads all of them back into the mode. Throws Fault::protocol for a value that does not read back, Fault::usage for
/// one that the camera has no setting for.
void set_controls(const V4l2Node& node, const CameraSettings& settings, CameraMode& mode);

}  // namespace vam::device

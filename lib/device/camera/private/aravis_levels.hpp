// SPDX-License-Identifier: GPL-3.0-or-later
// What decides how a GenICam camera makes grey levels of light.
#pragma once

#include <string>

#include "device/camera/camera.hpp"

struct _ArvCamera;  // NOLINT: Aravis' own name, whose header stays in the sources

namespace vam::device {

/// Switches off every automatic that the camera has, then sets gamma, gain and black level, and reads all of them back
/// into the mode. Throws Fault::protocol for a value that does not read back, Fault::usage for one that the camera has
/// no setting for.
void set_levels(_ArvCamera* camera, const std::string& name, const CameraSettings& settings, CameraMode& mode);

}  // namespace vam::device

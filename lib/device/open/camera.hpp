// SPDX-License-Identifier: GPL-3.0-or-later
// Which camera a device string names.
#pragma once

#include "device/camera/camera.hpp"

namespace vam::device {

/// aravis:ID-or-IP (GenICam: USB3 Vision, GigE Vision), v4l2:/dev/video0, replay:DIR-or-STACK (?pace=real), sim:
/// (simulated in the tool), locked for this process. Throws as the constructors and DeviceLock do, and Fault::usage for
/// a bad device string.
[[nodiscard]] std::unique_ptr<Camera> open_camera(const std::string& device, const CameraSettings& settings,
                                                  const CameraBench& bench, Clock& clock);

/// The devices that open_camera knows, for --help: "aravis:ID-or-IP, v4l2:PATH, replay:PLACE or sim:".
[[nodiscard]] std::string camera_devices();

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// The constructors behind open_camera().
#pragma once

#include "device/camera/camera.hpp"
#include "device/camera/v4l2_driver.hpp"

namespace vam::device {

/// Options packet_size (GigE Vision, bytes) and buffers. An empty place is the only camera there is.
[[nodiscard]] std::unique_ptr<Camera> open_aravis_camera(const Address& address, const CameraSettings& settings,
                                                         Clock& clock);

/// Option buffers. Exposure, frame rate and the formats GREY, Y10, Y12, Y16, YUYV and UYVY (their luma).
[[nodiscard]] std::unique_ptr<Camera> open_v4l2_camera(const Address& address, const CameraSettings& settings,
                                                       std::unique_ptr<V4l2Driver> driver, Clock& clock);

/// Option pace=virtual (as fast as it can be read, recorded times) or real (in step with the recorded times, from now).
[[nodiscard]] std::unique_ptr<Camera> open_replay_camera(const Address& address, const CameraSettings& settings,
                                                         const CameraBench& bench, Clock& clock);

/// "8 x 4 pixels instead of 8 x 8" when an image has another size than the camera said.
[[nodiscard]] std::optional<std::string> another_size(const CameraMode& mode, int columns, int rows);

/// The option pace. Throws Fault::usage unless it is real or virtual.
[[nodiscard]] bool in_real_pace(const Address& address, const std::string& fallback);

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// The constructors behind open_camera(), and the cameras that this machine sees.
#pragma once

#include <vector>

#include "device/camera/camera.hpp"
#include "device/camera/v4l2_driver.hpp"
#include "device/os/device_listing.hpp"

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

/// GenICam cameras on USB3 Vision and GigE Vision (Aravis asks the network for a second at most), by address on a
/// network, else by their name there; and Video4Linux cameras.
[[nodiscard]] std::vector<DeviceListing> find_cameras();

/// A camera's setting is what it reads back as, not what it was set to. `subject`: the camera and the setting. Throws
/// Fault::protocol where `got` differs from `wanted` by more than 1 % and `grain`, the step of the setting.
void require_read_back(const std::string& subject, double wanted, double got, double grain);

/// The option pace. Throws Fault::usage unless it is real or virtual.
[[nodiscard]] bool in_real_pace(const Address& address, const std::string& fallback);

}  // namespace vam::device

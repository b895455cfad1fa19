// SPDX-License-Identifier: GPL-3.0-or-later
// The simulated camera behind "sim:".
#pragma once

#include "device/camera/camera.hpp"

namespace vam::sim {

/// Options of sim/bench/scene.hpp and pace=real or virtual (frames at their period, without waiting for it).
[[nodiscard]] std::unique_ptr<device::Camera> open_sim_camera(const device::Address& address,
                                                              const device::CameraSettings& settings,
                                                              const device::CameraBench& bench, device::Clock& clock);

}  // namespace vam::sim

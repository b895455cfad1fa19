// SPDX-License-Identifier: GPL-3.0-or-later
// What simulated cameras have in common, in this process (sim:) or behind a network (vam-sim camera).
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "device/camera/camera.hpp"
#include "sim/bench/print.hpp"
#include "sim/bench/world.hpp"
#include "sim/controllers/device.hpp"

namespace vam::sim {

struct SimCameraSettings {
  SimBench bench;
  SimSources sources;
  double fps = 25;
  double exposure_us = 20000;
  int bits = 8;
  std::string maker = "aravis";
  std::optional<device::StampMoment> stamp;    // that time stamps name; none: as the maker says
  bool latch = true;                           // the camera's clock can be read
  double lag_s = 0;                            // from that moment to the time stamp
  std::set<long> drop;                         // numbers of frames that never arrive
  std::set<long> incomplete;                   // and of those whose lower half does not
  long unplug = -1;                            // the camera is unplugged before this frame
  std::function<void(const SimPrint&)> cured;  // every quarter turn, what light has made of the resin
  long shrink = -1;                            // from this frame on, one after the first, images are half as high
};

/// "3,7" to numbers of frames. Throws Fault::usage.
[[nodiscard]] std::set<long> parse_frames(const std::string& text);

/// The camera behind "sim:", with options of sim/bench/scene.hpp and pace=real or virtual (frames at their period,
/// without waiting for it).
[[nodiscard]] std::unique_ptr<device::Camera> open_sim_camera(const device::Address& address,
                                                              const device::CameraSettings& settings,
                                                              const device::CameraBench& bench, device::Clock& clock);

}  // namespace vam::sim

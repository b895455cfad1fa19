// SPDX-License-Identifier: GPL-3.0-or-later
// vam-capture's plain form and identify.
#pragma once

#include <optional>
#include <string>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "device/camera/camera.hpp"
#include "io/exr/stack.hpp"

namespace vam::capture_tool {

struct Options {
  std::string device;  // empty: camera.device
  std::string output = "-";
  std::string follow;
  std::optional<double> speed_deg_s, angle_deg, every_deg, pixel_mm, turns;
  std::optional<int> frames, max_lost;
  std::optional<double> lag_ms;  // absent: camera.lag_ms
  bool live = false;
  bool with_parent = false;
  std::string latest, log, report;
  device::CameraSettings camera;
  cli::PrinterOptions printer;
  io::StackOptions stack;
};

void identify(const cli::App& app, const Options& options);
void take(const cli::App& app, const Options& options);

}  // namespace vam::capture_tool

// SPDX-License-Identifier: GPL-3.0-or-later
// The options of vam-dose, for all its files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "model/printer.hpp"
#include "optics/resample_stack.hpp"

namespace vam::dose_tool {

struct Options {
  std::vector<std::string> inputs{"-"};
  std::string output = "-";
  std::string like;
  std::optional<double> size_mm;
  std::string poses;
  std::optional<double> full_scale;
  std::optional<double> diffusion_time_s;
  std::optional<int> bits, dither_turns;
  bool no_blur = false;
  bool in_plane = false;
  std::string negative = "clip";
  bool exposure_plan = false;
  std::vector<std::string> shown;
  std::optional<double> before_s;
  double angle_offset_deg = 0;
  optics::AxisAlignment alignment;
  std::string report;
  cli::PrinterOptions printer;
};

void declare(cli::App& app, Options& options);

}  // namespace vam::dose_tool

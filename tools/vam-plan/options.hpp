// SPDX-License-Identifier: GPL-3.0-or-later
// Options of vam-plan.
#pragma once

#include <optional>
#include <string>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "session/surface.hpp"

namespace vam::plan_tool {

struct Options {
  std::string input = "-";
  std::string shape;
  std::string unit = "mm";
  std::string up = "z";
  double scale = 1;
  session::ArrayOptions array;
  std::optional<double> voxel_mm;  // none: a pixel
  bool unit_given = false;
  bool unit_known = false;  // it or the scale is given
  bool no_preview = false;
  bool printers = false;
  std::string require, report;
  cli::PrinterOptions printer;
};

void declare(cli::App& app, Options& options);

}  // namespace vam::plan_tool

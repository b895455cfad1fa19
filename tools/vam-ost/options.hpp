// SPDX-License-Identifier: GPL-3.0-or-later
// Options of vam-ost.
#pragma once

#include <optional>
#include <string>

#include "cli/common.hpp"
#include "metrology/ost/ost.hpp"

namespace vam::ost_tool {

struct Options {
  std::string views = "-";
  std::string output = "-";
  std::optional<double> step_deg;
  std::string dark, flat;
  int binning = 1;
  std::optional<double> pixel_mm, axis_column, tilt_deg;
  metrology::OstOptions how;
  bool no_refraction = false;
  bool keep_run_out = false;
  std::string negative = "clip";
  std::optional<double> isovalue;
  std::optional<double> pieces_mm3;
  std::string resin_record;
  std::string mesh, projections, uncertainty;
  bool live = false;
  bool uncertainties = false;
  double every_deg = 360;
  std::string target, until, log, page;
  std::string report;
  cli::PrinterOptions printer;
};

}  // namespace vam::ost_tool

// SPDX-License-Identifier: GPL-3.0-or-later
// What vam-print is asked for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "cli/common.hpp"

namespace vam::print_tool {

struct Options {
  std::string sinogram;
  std::string display, light;
  cli::PrinterOptions printer;
  std::optional<int> turns;
  double run_up_turns = 1;
  bool home = false;
  std::optional<int> frames_per_turn;
  double max_missed = 0.001, max_missed_lit = 0.01;
  std::string need = "edges,response";
  bool uncalibrated = false;
  bool accept_printer = false, accept_dose = false;
  std::optional<double> view_step_deg;
  int dark_turns = 0;
  std::string until, target, isovalue, resin;  // of vam-ost
  bool correct = false;
  double axis_sigma_px = 0;
  std::string run, resume;
  bool page = false;
  bool plan = false, commands = false;

  [[nodiscard]] bool has_views() const { return view_step_deg.has_value(); }
};

void declare(cli::App& app, Options& options);

/// What declarations cannot say. Throws Fault::usage, Fault::no_input without a sinogram.
void require_sound(const Options& options);

/// The required calibration scans; none: without records.
[[nodiscard]] std::vector<std::string> needed_scans(const Options& options);

}  // namespace vam::print_tool

// SPDX-License-Identifier: GPL-3.0-or-later
// The options of vam-optimize, for all its files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr/stack.hpp"
#include "model/tolerances.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize_tool {

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string method = "auto";
  std::string geometry = "vial";
  int angles = 360;
  std::optional<int> bins;
  std::string poses;  // one of the three, or none
  std::optional<double> helix_mm;
  std::string wobble_record;
  optimize::Demands demands;  // target constraints
  double surface_margin_mm = 0;
  std::string weights, band_volume;
  std::vector<std::string> delivered;  // doses of the resin before this light
  std::string response = "logistic";
  std::string void_rule = "met";
  double void_weight = 1;
  std::optional<double> void_band;
  std::optional<double> softness;
  std::optional<int> iterations;  // stopping criteria
  optimize::Limits limits;
  std::string until;
  std::string init;
  bool coarse_start = false;  // from the same part at half of the resolution
  std::string checkpoint;
  std::string slices;  // of the stack, that are written; empty: all
  std::string trace;
  optimize::MethodOptions how;
  std::optional<double> max_intensity;
  std::optional<double> turns;  // of the print, at full grey
  bool shortest = false;
  std::string tradeoff;
  std::string certify;
  bool preview = false;
  std::optional<double> budget_s;
  optimize::IntensityLimit limit;
  optimize::Raising raising;
  std::string robust;
  std::optional<model::Tolerances> printer_tolerances;  // as read from it
  bool recorded_tolerances = false;                     // and from the calibration records
  int yield_printers = 200;
  std::string negative = "clip";
  std::string absorption_model = "exact";
  std::string line_integrals = "footprints";
  bool no_blur = false;
  std::optional<double> diffusion_time_s;
  std::optional<int> bits;  // the projector's grey levels
  std::optional<double> full_scale;
  double column_offset_px = 0;
  std::optional<int> dither_turns;
  cli::PrinterOptions printer;
  std::string report;
  io::StackOptions stack;

  [[nodiscard]] bool in_vial() const { return geometry == "vial"; }
};

/// As many angles as the projections have from which it starts, unless --angles says otherwise. Throws as StackReader.
void settle_angles(const cli::App& app, Options& options);

void declare(cli::App& app, Options& options);
/// Fills in what follows from other options, no file opened. Throws Fault::usage for options that contradict each
/// other.
void settle(const cli::App& app, Options& options);
/// The tolerances of calibration records where --robust asks for them and names no others; one line on a terminal says
/// which. Throws as io::recorded_tolerances does.
void settle_recorded(const model::Printer& printer, Options& options);
/// The response curve of --resin-response, and the window that a table of it gives. Throws Error when it cannot be
/// read.
void settle_response(const cli::App& app, Options& options);

}  // namespace vam::optimize_tool

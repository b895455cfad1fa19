// SPDX-License-Identifier: GPL-3.0-or-later
// The options of vam-slice, for all its files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "model/printer.hpp"
#include "session/surface.hpp"
#include "solid/voxel/part.hpp"

namespace vam::slice_tool {

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string shape;
  std::string insert;
  std::string insert_shape;
  std::string insert_unit = "mm";
  bool unit_given = false;
  bool insert_unit_given = false;
  double insert_scale = 1;
  std::vector<double> insert_rotate_deg;
  std::vector<double> insert_at_mm;
  std::optional<double> clearance_mm;  // the insert is cut out of the part
  std::string fill = "auto";
  std::vector<double> wrap_mm;  // alpha and offset of fill wrap
  std::optional<double> voxel_mm;
  std::vector<std::string> compensate;
  double damping = 0.8;
  session::ArrayOptions array;
  std::string extent = "part";
  std::string unit = "mm";
  std::string up = "z";
  std::string mirror = "none";
  solid::Placement placement;
  std::vector<double> rotate_deg;
  bool no_centre = false;
  bool any_height = false;
  std::string place;
  std::optional<double> stretch_z;
  std::string report;
  cli::PrinterOptions printer;
};

void declare(cli::App& app, Options& options);
/// Throws Fault::usage for options that do not apply to what PART is.
void check(const cli::App& app, const Options& options);
/// Fills in what follows from other options and the printer: units, voxel and stretch.
void resolve(Options& options, const model::Printer& printer);
/// The options that help a part which does not fit.
[[nodiscard]] solid::PlacementAdvice advice(const Options& options);
[[nodiscard]] bool is_folder(const std::string& path);

}  // namespace vam::slice_tool

// SPDX-License-Identifier: GPL-3.0-or-later
// The options of vam-convert, for all its files.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/exr/stack.hpp"
#include "model/printer.hpp"

namespace vam::convert_tool {

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string array;
  std::string axes;
  std::string grid;
  std::optional<double> full_scale;
  std::optional<double> voxel_mm;
  std::vector<double> origin_mm;
  std::optional<double> stretch_z;
  std::string units = "relative";
  std::string geometry = "none";
  std::optional<double> pixel_mm;
  std::optional<double> slice_height_mm;
  std::string like;
  std::optional<double> view_step_deg;
  std::optional<double> speed_deg_s;
  std::optional<double> axis_column;
  std::optional<double> axis_row;
  std::string orientation = "normal";
  cli::PrinterOptions printer;
  io::StackOptions stack;
  /// Whether the columns are those of the projector, whose rays the vial refracts.
  [[nodiscard]] bool in_vial() const { return geometry == "vial"; }
};

void declare(cli::App& app, Options& options);

/// Which axis of the array counts images, rows and columns, as io::ArrayOptions has it, where `letters` name them in
/// this order: "zyx", "zax".
/// Throws Fault::usage unless --axes has just these letters.
[[nodiscard]] std::array<int, 3> axes_of(const Options& options, const std::string& letters);

/// Out of these tools: throws Fault::usage for an output that is not .npy.
void check_export(const Options& options);
/// Into them: throws Fault::usage unless it is said whether a volume or projections are made.
void check_import(const Options& options);

}  // namespace vam::convert_tool

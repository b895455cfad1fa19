// SPDX-License-Identifier: GPL-3.0-or-later
// The options of vam-convert, for all its files.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "io/array/array_file.hpp"
#include "io/exr/stack.hpp"
#include "model/printer.hpp"

namespace vam::convert_tool {

/// How a program keeps what it computes.
struct Convention {
  std::string_view program;
  std::string_view volume_axes, projection_axes;  // of arrays, as --axes
  std::string_view frames;                        // as --orientation
  double zero_deg;                                // stage angle of its projections at 0,
  int sense;                                      // from where they go on: -1: downwards
  bool volume_at_half, columns_at_half;           // is the axis on N / 2, rounded down, of N; else in the middle
  bool speed_in_name;                             // part_9rpm.mp4
};

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::string array;
  std::string axes;
  std::string from = "none";
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
  std::optional<double> first_angle_deg;
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

/// Those of --from, the first "none": of these tools.
[[nodiscard]] std::vector<std::string> programs();
[[nodiscard]] const Convention& convention_of(const std::string& program);
/// Where that has the axis among so many voxels or columns.
[[nodiscard]] double axis_of(int count, bool at_half);
/// That of a video by its name, as OpenCAL has it: part_9rpm.mp4.
[[nodiscard]] std::optional<double> named_speed_deg_s(const std::string& path);

/// The array and its axes that count images, rows and columns, where `letters` name them in this order: "zyx", "zax".
/// Throws Fault::usage unless --axes has just these letters, some behind a minus.
[[nodiscard]] io::ArrayOptions array_of(const Options& options, const std::string& letters);

/// Out of these tools: throws Fault::usage for an output that is not .npy.
void check_export(const Options& options);
/// Into them: throws Fault::usage unless it is said whether a volume or projections are made.
void check_import(const Options& options);

}  // namespace vam::convert_tool

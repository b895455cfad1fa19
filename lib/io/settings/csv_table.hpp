// SPDX-License-Identifier: GPL-3.0-or-later
// Small tables: CSV with a header line, for working curves, photodiode readings and catalogues; a projector's response;
// poses of the stage.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/pose.hpp"
#include "model/printer.hpp"
#include "model/response_table.hpp"

namespace vam::io {

/// Cells in the order of the requested columns.
struct CsvTable {
  std::string source;  // file name, for messages
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::vector<int> lines;  // line number of each row

  /// Throws Fault::data with file, line and column when the cell is not a finite number.
  [[nodiscard]] double number(std::size_t row, std::size_t column) const;
  [[nodiscard]] std::vector<double> column(std::size_t column) const;
};

/// Reads the named columns, in whatever order the header has them; further columns are ignored. Without names, all that
/// the header has, which must be there. Lines that are empty or
/// begin with # are skipped. A file whose first line is all numbers has no header: its columns are taken in the order
/// given here. "-" is stdin. Throws Error:
/// no_input, io, data (a column missing, a row too short, no rows).
[[nodiscard]] CsvTable read_csv(const std::string& path, const std::vector<std::string>& columns);

/// Reads two comma-separated columns; lines that are empty or begin with # are skipped, a first line of words is the
/// header. Intensity in any unit: the last line is full grey. Warns where that is below 2^bits - 1. Throws Error:
/// no_input, data (with file and line: not two numbers, grey not rising from 0, negative, falling or absurd intensity,
/// fewer than two lines, greys above 2^bits - 1).
[[nodiscard]] model::ResponseTable read_response(const std::string& file, int bits);

/// Reads the columns angle_deg,dx_mm,dy_mm,dz_mm,moves, one line a frame [formats: Poses]. Throws Error: no_input, io,
/// data (not such a table).
[[nodiscard]] model::Poses read_poses(const std::string& path);

/// Throws Fault::data unless there is a pose for every one of `frames` frames, or for any number of them if that is 0,
/// at stage angles start, start + step and so on.
void require_angles(const std::string& path, const model::Poses& poses, int frames, double start_deg, double step_deg);

/// How the vial's axis circles the rotation axis.
struct WobbleRecord {
  double radius_mm = 0;
  double lab_angle_deg = 0;  // direction of the vial at stage angle 0, from +x towards +y
};
/// From a record of `vam-calibrate edges`, which looks along the projector, or `axis`, which looks along the camera.
/// Throws Error: no_input, data (another file, or a record without wobble).
[[nodiscard]] WobbleRecord read_wobble(const std::string& path, const model::Printer& printer, int direction);

/// The radius of the wobble in the edges record in force, in mm, where it is more than three standard deviations; else
/// nothing. Throws what current_record() throws.
[[nodiscard]] std::optional<double> wobble_in_force_mm(const model::Calibration& calibration);

}  // namespace vam::io

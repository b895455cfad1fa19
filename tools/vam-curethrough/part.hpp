// SPDX-License-Identifier: GPL-3.0-or-later
// The part in printing order.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "io/vdb/vdb.hpp"
#include "resin/curethrough/part_columns.hpp"

namespace vam::curethrough {

struct PartOptions {
  std::string path = "-";
  std::string platform = "bottom";  // which end of z is printed first
  double threshold = 0.5;
};
/// not_for: kinds of input without a part.
void add_part(cli::App& app, PartOptions& options, const std::vector<std::string>& not_for = {});

/// A target volume, one bit a voxel; slice 0 is the one at the platform. Read in one go, file or pipe.
class PartFile {
 public:
  PartFile(const PartOptions& options, resin::ExposureMode exposure);
  [[nodiscard]] const resin::PartColumns& columns() const { return *columns_; }
  [[nodiscard]] const model::Grid& grid() const { return grid_; }
  [[nodiscard]] const std::vector<std::string>& history() const { return history_; }
  [[nodiscard]] double slice_um() const { return grid().voxel_mm * 1e3; }
  [[nodiscard]] double threshold() const { return options_.threshold; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// The grid of something that has `slices` slices in printing order, of which the first are this part's.
  [[nodiscard]] model::Grid extended(int slices) const;
  /// Slices in printing order to those of `volume`, a SparseVolume on extended().
  void write(io::SparseVolume& volume, int first, int count, std::vector<float>& slices) const;

 private:
  void take(const io::VoxelBlock& block);
  [[nodiscard]] std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(grid().nx) + x;
  }
  [[nodiscard]] bool upside_down() const { return options_.platform == "top"; }
  PartOptions options_;
  std::string name_;
  float least_;  // value of a voxel in the part
  model::Grid grid_;
  std::vector<std::string> history_;
  std::optional<resin::PartColumns> columns_;
};

}  // namespace vam::curethrough

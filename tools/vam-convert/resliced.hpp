// SPDX-License-Identifier: GPL-3.0-or-later
// Slices at the heights of a volume's voxels.
#pragma once

#include <deque>
#include <optional>

#include "base/image.hpp"
#include "model/grid.hpp"
#include "vam-convert/sinograms.hpp"

namespace vam::convert_tool {

/// Interpolated linearly between slices, or averaged over those that a voxel spans; beyond half a slice from the last
/// one it is dark.
class Resliced {
 public:
  /// Slice 0 is at z0_mm. Without a grid the slices are as they come.
  Resliced(Slices& slices, double z0_mm, double pitch_mm, const std::optional<model::Grid>& grid);
  [[nodiscard]] int count() const { return grid_ ? grid_->nz : slices_.size().images; }
  /// Upwards; false after the last.
  bool next(Image& slice);
  /// After the last: the share of the light that lies below or above the volume.
  [[nodiscard]] double left_out();

 private:
  bool take();
  [[nodiscard]] double weight(int source, double place) const;

  Slices& slices_;
  double z0_mm_;
  double pitch_mm_;
  std::optional<model::Grid> grid_;
  std::deque<Image> window_;
  int first_ = 0;  // slice at the front of the window
  int done_ = 0;
  double light_ = 0;
  double beside_ = 0;
};

}  // namespace vam::convert_tool

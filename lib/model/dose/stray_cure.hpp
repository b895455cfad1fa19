// SPDX-License-Identifier: GPL-3.0-or-later
// What a print leaves outside the part's box: resin that is lit, too, and may gel.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/text/json_fwd.hpp"
#include "model/dose/dose_histogram.hpp"
#include "model/grid.hpp"

namespace vam::model {

/// A box of voxels of a grid: indices (i, j, k), both ends included; without voxels where low is above high.
struct VoxelBox {
  std::array<int, 3> low{};
  std::array<int, 3> high{-1, -1, -1};
  [[nodiscard]] bool contains(int i, int j, int k) const {
    return i >= low[0] && i <= high[0] && j >= low[1] && j <= high[1] && k >= low[2] && k <= high[2];
  }
};

/// The smallest box that holds all voxels whose value is above that.
[[nodiscard]] VoxelBox covered_box(const Volume& volume, float above);

/// Void voxels within the lit resin that the part's box does not contain.
struct StrayCure {
  std::int64_t voxels = 0;
  std::int64_t gelled_voxels = 0;  // with at least the threshold dose
  double max_dose = 0;

  void add(float dose, double threshold) {
    ++voxels;
    gelled_voxels += static_cast<double>(dose) >= threshold ? 1 : 0;
    max_dose = std::max(max_dose, static_cast<double>(dose));
  }
  void merge(const StrayCure& other) {
    voxels += other.voxels;
    gelled_voxels += other.gelled_voxels;
    max_dose = std::max(max_dose, other.max_dose);
  }
};

/// Gathers the doses of these voxels where the threshold is not known yet.
class StrayDoses {
 public:
  void add(float dose) {
    doses_.add(dose);
    most_ = std::max(most_, static_cast<double>(dose));
  }
  void merge(const StrayDoses& other) {
    doses_.merge(other.doses_);
    most_ = std::max(most_, other.most_);
  }
  /// Counts are to 2^-12 of the threshold; none gels where the largest dose is below it.
  [[nodiscard]] StrayCure at(double threshold) const {
    return {doses_.total(), most_ >= threshold ? doses_.count_from(threshold) : 0, most_};
  }

 private:
  DoseHistogram doses_;
  double most_ = 0;
};

/// The fields outside_voxels, outside_gelled_voxels and outside_max_dose.
void append_json(Json& report, const StrayCure& outside);

}  // namespace vam::model

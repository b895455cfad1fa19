// SPDX-License-Identifier: GPL-3.0-or-later
// The rays through voxels whose pose differs from frame to frame [physics §11].
#pragma once

#include <vector>

#include "light/rays/private/displaced_vial.hpp"
#include "light/rays/vial_setup.hpp"

namespace vam::light {

/// Where a frame puts the voxels, and what its vial does to the rays [physics §11]. The table holds the vial's frame: a
/// part that moves in the vial is looked up elsewhere, a vial that moves changes the points.
class PosedRays {
 public:
  PosedRays() = default;
  /// Throws Fault::data when the vial is displaced by more than the polynomials hold for.
  PosedRays(const VialSetup& setup, const RayTable::Scope& rays, const RayTable& table);

  [[nodiscard]] double lift_mm(int frame) const { return frames_[frame].lift_mm; }

  /// The nodes of the rays through a point of the part, at most RayTable::most_sheets; returns how many.
  int find(const RayTable& table, double x_mm, double y_mm, int frame, const HeightScale& scale,
           const LightSpread& spread, RayNode* to) const;

 private:
  struct FramePose {
    double cosine = 1, sine = 0;  // of the part's angle
    double x_mm = 0, y_mm = 0;    // of the part in the vial
    double lift_mm = 0;
    bool shifted = false;  // whether the vial is displaced
    DisplacedVial::Powers powers{};
  };
  int sense_ = 1;
  std::vector<FramePose> frames_;
  DisplacedVial shift_;
};

}  // namespace vam::light

// SPDX-License-Identifier: GPL-3.0-or-later
// The rays through voxels whose pose differs from frame to frame [physics §11].
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "light/rays/private/ray_table.hpp"
#include "light/rays/vial_setup.hpp"
#include "optics/skew_ray.hpp"

namespace vam::light {

/// Every quantity of a point (TableNode) is a polynomial of second degree in the displacement of the vial, fitted to
/// rays that are traced through displaced vials; small and smooth, so that a coarse table does. Within the reach only.
class DisplacedVial {
 public:
  /// Of dx, dy, dx^2, dx dy and dy^2, in units of the largest displacement.
  using Powers = std::array<float, 5>;
  static constexpr int floats = 14;  // of a TableNode

  DisplacedVial(const RayTable::Scope& scope, const RayTable& table, double largest_mm);

  [[nodiscard]] Powers powers(const optics::Displacement& vial) const;
  /// Adds what it changes at radius r and `turn`, the direction in turns as the table counts it, 0 to 1.
  void add(float r_mm, float turn, const Powers& powers, std::array<float, floats>& node) const;

 private:
  using Change = std::array<std::array<float, floats>, std::tuple_size_v<Powers>>;
  [[nodiscard]] Change fit(const RayTable::Scope& scope, const RayTable& table, int row, int direction) const;

  double largest_mm_ = 0;
  double pitch_mm_ = 0;
  int rows_ = 0;
  std::vector<Change> points_;  // [row][direction], the first direction once more at the end
};

/// Where a frame puts the voxels, and what its vial does to the rays [physics §11]. The table holds the vial's frame: a
/// part that moves in the vial is looked up elsewhere, a vial that moves changes the points.
class PosedRays {
 public:
  PosedRays() = default;
  /// Throws Fault::data when the vial is displaced by more than the polynomials hold for.
  PosedRays(const VialSetup& setup, int sense, const RayTable& table);

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
  std::shared_ptr<const DisplacedVial> shift_;
};

}  // namespace vam::light

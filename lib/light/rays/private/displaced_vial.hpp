// SPDX-License-Identifier: GPL-3.0-or-later
// Change of the rays of the table where the vial is displaced from the rotation axis [physics §11].
#pragma once

#include <array>
#include <vector>

#include "light/rays/private/ray_table.hpp"
#include "optics/skew_ray.hpp"

namespace vam::light {

/// Every quantity of a point (TableNode) is a polynomial of second degree in the displacement of the vial, fitted to
/// rays that are traced through displaced vials; small and smooth, so that a coarse table does. Within the reach only.
class DisplacedVial {
 public:
  /// Of dx, dy, dx^2, dx dy and dy^2, in units of the largest displacement.
  using Powers = std::array<float, 5>;
  static constexpr int floats = 14;  // of a TableNode

  DisplacedVial() = default;
  DisplacedVial(const RayTable::Scope& scope, const RayTable& table, double largest_mm);

  [[nodiscard]] bool empty() const { return points_.empty(); }
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

}  // namespace vam::light

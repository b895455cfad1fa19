// SPDX-License-Identifier: GPL-3.0-or-later
// From slices of a part to the projections to show: project, filter, weight.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tomo/filter.hpp"
#include "tomo/radon.hpp"

namespace vam::tomo {

struct ProjectionSpec {
  ParallelGeometry geometry;  // alpha_per_px != 0: the exponential transform and its inverse filter
  double voxel_mm = 1;
  FilterSpec filter{FilterWindow::none, 1, 0, 0};
  std::optional<double> wall_radius_mm;  // give the light at this radius instead of at the axis, in an absorber
};

/// Values without a filter: integrals of coverage along lines, in mm. With one: light per radian of turn, such that the
/// dose sum over all angles, angle_step_rad * A* g (with weight e^{-alpha u}), is the part again
/// [physics §4, physics §5].
/// vam-sinogram writes them, and absorbing light (light::AttenuatedOperator) is inverted by them.
class FilteredProjections {
 public:
  explicit FilteredProjections(const ProjectionSpec& spec);
  /// Fills the sinograms. Several slabs a call share the weights.
  void apply(std::span<const Slab> images, std::span<Slab> sinograms) const;

 private:
  ProjectionSpec spec_;
  Filter filter_;
  std::vector<float> weights_;  // per column
};

/// Slabs a pass, 1 to 4, so that the largest slab of each kind keeps a pass within `budget_bytes`.
[[nodiscard]] int slabs_a_pass(const ParallelGeometry& geometry, std::size_t budget_bytes = std::size_t{1} << 30);

}  // namespace vam::tomo

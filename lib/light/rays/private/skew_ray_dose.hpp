// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of a skew ray at a point, T e^{-mu l} / (|determinant| cos epsilon) [physics §11], at three heights, and the
// polynomials between these.
#pragma once

#include "light/rays/private/chief_ray_dose.hpp"
#include "optics/skew_ray.hpp"

namespace vam::light {

/// The ray through a point, at one height: fields as of TableNode.
struct FoundRay {
  bool hits = true;
  double x_p_mm = 0, row = 1, strength = 0, spacing = 1;
  double delta_rad = 0;
};

/// The ray at height z, near a level one. At the rim, where level rays still pass, those that climb may not: there they
/// carry nothing.
[[nodiscard]] FoundRay ray_at(const ChiefRayDose& light, double x_mm, double y_mm, double z_mm, const FoundRay& level,
                              const optics::Displacement& vial = {});

/// Polynomials in z^2 through the rays at height 0, at the middle one (of node_over_heights) and at the largest.
[[nodiscard]] TableNode node_of(const FoundRay& level, const FoundRay& middle, const FoundRay& top);

/// The point with its rays at the other heights.
[[nodiscard]] TableNode node_over_heights(const ChiefRayDose& light, double x_mm, double y_mm, const FoundRay& level,
                                          const optics::Displacement& vial = {});

}  // namespace vam::light

// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of a ray at a point: of a level chief ray, T / |J - u ddelta/dx_p| e^{-mu s} [RAY21 eq 8; physics §4], on
// circles of the laboratory; of a skew ray, T e^{-mu l} / (|determinant| cos epsilon) [physics §11], at three heights,
// and the polynomials between these.
#pragma once

#include "light/rays/private/ray_table.hpp"
#include "optics/chief_ray.hpp"
#include "optics/skew_ray.hpp"

namespace vam::light {

/// The chief rays of a level fan at the points of a circle of radius r: everything at the angle b from the ray's own
/// normal, where t = r cos b and u = r sin b.
struct ChiefRayDose {
  struct OnCircle {
    double alpha = 0;
    double alpha_rate = 1;  // d alpha / d b = 1 - u (d delta / d x_p) / J
    double x_p_mm = 0;
    double strength = 0;  // T / J e^{-mu s}, per d b
    optics::ChiefRay ray;
    double u_mm = 0;

    /// T / |J - u ddelta/dx_p| e^{-mu s} [RAY21 eq 8], where alpha rises with b.
    [[nodiscard]] double dose() const { return strength / alpha_rate; }
  };

  const RayTable::Scope& scope;
  double edge_mm;
  double reach_mm;

  [[nodiscard]] OnCircle at(double r_mm, double b_rad) const;

  /// e^{-mu s} at depth u of a ray that climbs as steeply.
  [[nodiscard]] double transmitted(double offset_mm, double u_mm, double steepness) const;

  /// At the rim rays crowd without bounds, and carry next to nothing: a voxel is read there over fewer columns than it
  /// covers.
  [[nodiscard]] double spacing(double exact) const;

  /// d z_p / d z of low rays at depth u.
  [[nodiscard]] double low_zoom(double x_p_mm, double u_mm) const;
};

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

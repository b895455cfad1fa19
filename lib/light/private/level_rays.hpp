// Level rays on circles of the lab, before they are sorted into the table.
#pragma once

#include "light/private/ray_table.hpp"
#include "optics/chief_ray.hpp"

namespace vam::light {

/// What the chief rays of a level fan do at the points of a circle of radius r: everything at angle b from the ray's
/// own normal, where t = r cos b and u = r sin b.
struct LevelRays {
  /// Rays at the very rim graze the glass and carry no light.
  static constexpr double rim = 1 - 1e-9;

  struct Point {
    double alpha = 0;
    double alpha_rate = 1;  // d alpha / d b = 1 - u (d delta / d x_p) / J
    double x_p_mm = 0;
    double strength = 0;  // T / J e^{-mu s}, still per d b [RAY21 eq 8]
    optics::ChiefRay ray;
    double u_mm = 0;
  };

  const RayTable::Scope& scope;
  double edge_mm;
  double reach_mm;

  [[nodiscard]] Point at(double r_mm, double b_rad) const;

  /// e^{-mu s} at depth u of a ray that climbs as steeply.
  [[nodiscard]] double transmitted(double offset_mm, double u_mm, double steepness) const;

  /// At the rim rays crowd without bounds, and carry next to nothing: a voxel is read there over fewer columns than it
  /// covers.
  [[nodiscard]] double spacing(double exact) const;

  /// d z_p / d z of low rays at depth u.
  [[nodiscard]] double low_zoom(double x_p_mm, double u_mm) const;
};

}  // namespace vam::light

// SPDX-License-Identifier: GPL-3.0-or-later
// Skew chief rays, z(u) = z_0 + u tan epsilon: from a point of the image plane to a line in the resin, exactly in 3-D.
// Source: Bouguer's invariant for skew rays. Through interfaces whose normals are horizontal n sin(elevation) = s is
// conserved, so that a ray's plan view is that of a level ray with every index n replaced by sqrt(n^2 - s^2)
// [physics §2, §11].
//
// At z_p = 0 it is the ray of optics::chief_ray, which also has derivatives in closed form; tests compare the two.
#pragma once

#include "optics/chief_ray.hpp"

namespace vam::optics {

/// A chief ray in the resin. In plan it runs along the line of offset offset_mm at angle delta_rad (optics::ChiefRay),
/// u along the light; its height above the lens's axis is height_mm + climb * u, both in real millimetres.
struct SkewRay {
  bool hits = false;         // false: passes beside the resin or is totally reflected; the rest is 0 then
  double offset_mm = 0;      // signed, from the rotation axis
  double delta_rad = 0;      // angle of the plan view
  double height_mm = 0;      // at u = 0
  double climb = 0;          // dz / du, the tangent of the elevation in the resin
  double transmittance = 0;  // T, unpolarised, with the true angles of incidence [0, 1]

  [[nodiscard]] double z_mm(double u_mm) const { return height_mm + climb * u_mm; }
  /// Path length per length of plan view.
  [[nodiscard]] double steepness() const;
};

/// Where the vial's axis stands off the rotation axis, in the lab: x along the columns, y along the light. Lens, image
/// plane and window stay [physics §11].
struct Displacement {
  double x_mm = 0;
  double y_mm = 0;
};

/// The ray of the image-plane point (x_p_mm, z_p_mm) in the plane of the rotation axis, z_p measured from the lens's
/// axis. A view that is telecentric along a direction has rays that do not diverge in it. The ray is given in the
/// vial's frame, whose axis is the vial's.
[[nodiscard]] SkewRay skew_ray(const View& view, double x_p_mm, double z_p_mm, const Displacement& vial = {});

/// The slopes of a ray in air, dx / dy and dz / dy.
struct Slopes {
  double x = 0;
  double z = 0;
};

/// The slopes of the chief ray of that point.
[[nodiscard]] Slopes chief_slopes(const View& view, double x_p_mm, double z_p_mm);
/// The ray that would pass that point of the plane of the rotation axis with these slopes if nothing were in its way;
/// skew_ray is that of the chief slopes.
[[nodiscard]] SkewRay ray_of_slopes(const View& view, double x_mm, double z_mm, const Slopes& slopes,
                                    const Displacement& vial = {});

/// The view in which level rays have the plan of those that pass the plane of the axis at z_p: its indices are others
/// [physics §2]. In units of the cosine of the elevation in air, so that air stays 1.
[[nodiscard]] View plan_view(const View& view, double z_p_mm);

/// The ray through a point of the lab, found by Newton's method, and how dense rays are there.
struct RayAt {
  SkewRay ray;
  double x_p_mm = 0;
  double z_p_mm = 0;
  double spacing = 0;  // d x_p / d r, r across the ray in plan: how fast the column changes
  double density = 0;  // d x_p d z_p / (area across the ray): T * density is fluence per image-plane intensity
};

/// The ray through the point (x, y, z) of the vial's frame near the guess (x_p, z_p); `hits` is false where there is
/// none.
[[nodiscard]] RayAt ray_through(const View& view, double x_mm, double y_mm, double z_mm, double x_p_guess_mm,
                                double z_p_guess_mm, const Displacement& vial = {});

}  // namespace vam::optics

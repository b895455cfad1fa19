// SPDX-License-Identifier: GPL-3.0-or-later
// Chief rays through the vial in closed form: from a column of the projector (or camera) to a line of the part.
// Sources: [RAY21 eq 4, RAY21 eq 5, RAY21 eq 6, RAY21 eq 7] for one shell; Bouguer's invariant n b for any number of
// concentric shells [physics §2]. [OST22 eq 2, OST22 eq 3, OST22 eq 4] are the same. Level rays only, of which the
// derivatives are known in closed form: the way to the table of rays; skew_ray.hpp has the rays that climb, without
// derivatives, and agrees with this at the height of the lens.
#pragma once

#include <optional>
#include <vector>

#include "model/printer.hpp"

namespace vam::optics {

/// A cylinder around the axis and what fills it, up to the next shell.
struct Shell {
  double radius_mm = 0;
  double index = 1;
  bool operator==(const Shell&) const = default;
};

/// What one instrument sees of the vial. Columns are measured from the axis in the plane y = 0, light runs along +y.
struct View {
  std::optional<double> lens_mm;  // D_p, lens (pupil) to axis for columns [RAY21 eq 1, RAY21 eq 2]; empty = telecentric
  double bath_index = 1;          // n_0, what the outermost shell stands in
  double window_mm = 0;           // L, flat window from air to bath at y = -L; without effect when n_0 = 1
  std::vector<Shell> shells;      // outermost first; the last is the resin
  std::optional<double> rows_lens_mm = std::nullopt;  // lens to axis as the rows see it; empty = rays stay level
  bool operator==(const View&) const = default;
};

/// One chief ray. In the lab it runs along the line of offset x_v at angle delta, so at stage angle theta it lights
/// the part's line L(x_v, theta + delta) = { x_v (cos, sin) + u (-sin, cos) } [physics §2].
struct ChiefRay {
  bool hits = false;         // false: passes beside the resin, grazes it or is totally reflected; the rest is 0 then
  double x_v_mm = 0;         // signed offset from the axis in the resin
  double delta_rad = 0;      // angle of the line
  double transmittance = 0;  // T, unpolarised intensity transmittance of all interfaces (Fresnel) [0, 1]
  double jacobian = 0;       // J = d x_v / d x_p
  double delta_rate = 0;     // d delta / d x_p in rad/mm
};

/// The view of the projector, or of the camera by reversal of the light (with the resin's index at its wavelength).
/// Throws Fault::data where lens, window and vial cannot stand like that.
[[nodiscard]] View projector_view(const model::Printer& printer);
[[nodiscard]] View camera_view(const model::Printer& printer);

/// The ray of the column at x_p_mm.
[[nodiscard]] ChiefRay chief_ray(const View& view, double x_p_mm);

/// Of the reach: rays farther out graze the glass and carry no light. Nothing is asked of them, and the outermost miss.
inline constexpr double rim = 1 - 1e-9;

/// A column and the ray of it, which hits.
struct ColumnRay {
  double x_p_mm = 0;
  ChiefRay ray;
};

/// The column whose ray has offset x_v_mm in the resin, and that ray: the inverse of chief_ray, which is monotone in
/// x_p. The ray is made of the offset and not traced from the column, so that rounding cannot make it miss. Empty where
/// no ray hits, never within rim * reach_mm.
[[nodiscard]] std::optional<ColumnRay> column_of(const View& view, double x_v_mm);

/// The outermost column with x_p > 0 and its ray, at rim * reach_mm.
[[nodiscard]] ColumnRay edge_column(const View& view);

/// The column whose ray passes the axis at that distance before it meets the vial: the inverse of impact_mm.
[[nodiscard]] double column_of_impact(const View& view, double impact_mm);

/// Radius of the resin.
[[nodiscard]] double resin_radius_mm(const View& view);

/// Distance from the axis to the ray of column x_p_mm before it meets the vial. The column R_e that is tangent to a
/// vial of radius R gives R: in air R = R_e / sqrt(1 + (R_e / D_p)^2); [RAY21 eq 9] has the sign of the square wrong.
[[nodiscard]] double impact_mm(const View& view, double x_p_mm);

/// How far a vial is displaced along the columns for every mm that the column x_p_mm, its edge for one, moves with it.
[[nodiscard]] double displacement_rate(const View& view, double x_p_mm);

/// How the line of a pixel's ray in the resin changes with the angle in air between it and the chief ray, all of them
/// through the pixel's image. Seen from above it is x_v + a offset_rate, delta + a delta_rate, a being the angle;
/// along z it is higher by e (height_rate + u climb_rate), e being the tangent of the elevation [physics §4].
struct Bundle {
  bool hits = false;
  double offset_rate_mm = 0;
  double delta_rate = -1;
  double height_rate_mm = 0;
  double climb_rate = 0;
};

/// The bundle of a level chief ray; the image is in the plane focus_mm behind the axis, in air.
[[nodiscard]] Bundle bundle(const View& view, double x_p_mm, double focus_mm);

}  // namespace vam::optics

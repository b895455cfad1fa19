// SPDX-License-Identifier: GPL-3.0-or-later
// Lattices and the ball in a cage.
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "base/compute/simd.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "solid/shapes/private/builders.hpp"
#include "solid/shapes/private/gyroid_kernel.hpp"
#include "solid/shapes/private/sdf.hpp"

namespace vam::solid::build {

Field gyroid(Values v) {
  const double k = 2 * std::numbers::pi / v[0];
  const double half_sheet = v[1] / 2;
  const double radius = v[2] / 2;
  const double half = v[3] / 2;
  require(v[1] <= 0.2 * v[0], "shape gyroid: sheet is " + format_number(v[1]) + " mm, more than 0.2 times cell, " +
                                  format_number(0.2 * v[0]) +
                                  " mm, beyond which the offset surface is not smooth; reduce it");
  // Exact well beyond the sheet's surface, but not near the extrema of F (1.5), where Newton's steps go astray.
  const double near = std::min(1.6 * k * half_sheet, 1.25 / std::numbers::sqrt3);
  const auto distances = VAM_KERNEL(gyroid_distances, simd_level());
  const auto some = [=](std::span<const Point> points, double* values) {
    std::array<std::array<double, Field::together>, 3> at{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) at[a][i] = k * points[i][a];
    }
    std::array<double, Field::together> sheet{};
    constexpr int lanes = 8;  // whole registers: a point left over takes as long as one of them
    distances(at[0].data(), at[1].data(), at[2].data(), (count_of(points) + lanes - 1) / lanes * lanes, near,
              sheet.data());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point& p = points[i];
      const double hull = sdf::rectangle(std::sqrt(p[0] * p[0] + p[1] * p[1]), p[2], radius, half);
      values[i] = hull > half_sheet ? hull : std::max(hull, sheet[i] / k - half_sheet);
    }
  };
  Field field = solid({}, {-radius, -radius, -half}, {radius, radius, half}, radius,
                      1 / (0.2 * v[0] - half_sheet));  // the minimal surface bends to a radius of 0.2 cell
  field.some = some;
  field.ball_mm = std::hypot(radius, half);
  return field;
}

// The octet truss [CAL17 fig 8C]: the edges between nearest neighbours of a face-centred cubic lattice. A cell is
// mirror-symmetric about its middle planes, so one octant with the six edges of a tetrahedron describes it.
Field octet(Values v) {
  const double cell = v[0];
  const double strut = v[1] / 2;
  const double across = v[2];
  const double layers = v[3];
  require(2 * strut < 0.5 * cell, "shape octet: strut must be below half of cell");
  const Point count{across, across, layers};
  const Point half = (0.5 * cell) * count;
  Field field = solid(
      [=](const Point& p) {
        Point q{};  // within the octant of the nearest cell, 0 ... cell / 2
        for (std::size_t a = 0; a < 3; ++a) {
          const double index = std::clamp(std::floor((p[a] + half[a]) / cell), 0.0, count[a] - 1);
          q[a] = std::abs(p[a] + half[a] - (index + 0.5) * cell);
        }
        // Mirrors exchange the axes too: with the coordinates in order, two of the six edges can be nearest.
        if (q[0] < q[1]) std::swap(q[0], q[1]);
        if (q[1] < q[2]) std::swap(q[1], q[2]);
        if (q[0] < q[1]) std::swap(q[0], q[1]);
        const double h = 0.5 * cell;
        const double t = std::clamp(0.5 * (q[1] + q[2]), 0.0, h);      // (h, t, t): corner to face centre
        const double u = std::clamp(0.5 * (h - q[0] + q[1]), 0.0, h);  // (h - u, u, 0): face centre to face centre
        const Point to_corner = q - Point{h, t, t};
        const Point around = q - Point{h - u, u, 0};
        return std::sqrt(std::min(dot(to_corner, to_corner), dot(around, around))) - strut;
      },
      -1.0 * half - Point{strut, strut, strut}, half + Point{strut, strut, strut}, std::hypot(half[0], half[1]) + strut,
      1 / strut);
  field.ball_mm = length(half) + strut;
  return field;
}

// A loose ball in a round cage of meridians and an equator [CAL17 fig 8A, CAL19 fig 2D].
Field ball_in_cage(Values v) {
  const double strut = v[1] / 2;
  const double ring = v[0] / 2 - strut;
  const double ball = v[2] / 2;
  const double meridians = v[3];  // great circles through the poles
  require(ball + strut < ring, "shape ball-in-cage: ball touches the cage; ball must be below diameter - 2 strut");
  const double sector = std::numbers::pi / meridians;
  Field field = solid(
      [=](const Point& p) {
        const double r = std::hypot(p[0], p[1]);
        // Turn the nearest half circle into the half plane y = 0, x >= 0.
        const double angle = std::remainder(std::atan2(p[1], p[0]), sector);
        const double in_plane = std::hypot(r * std::cos(angle), p[2]) - ring;
        const double cage = std::min(std::hypot(in_plane, r * std::sin(angle)) - strut, sdf::torus(p, ring, strut));
        return std::min(cage, sdf::ball(p, ball));
      },
      {-ring - strut, -ring - strut, -ring - strut}, {ring + strut, ring + strut, ring + strut}, ring + strut,
      1 / strut);
  field.ball_mm = ring + strut;
  return field;
}

}  // namespace vam::solid::build

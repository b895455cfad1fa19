// Lattices and the ball in a cage.
#include <numbers>

#include "solid/sdf.hpp"
#include "solid/shape_builders.hpp"

namespace vam::solid::build {

namespace {

// The gyroid's level-set approximation F = sin x cos y + sin y cos z + sin z cos x [OST22 Methods, "Gyroid design"].
struct Level {
  double value;
  Point gradient;
};

Level gyroid_level(const Point& p, double k) {
  const double sx = std::sin(k * p[0]);
  const double cx = std::cos(k * p[0]);
  const double sy = std::sin(k * p[1]);
  const double cy = std::cos(k * p[1]);
  const double sz = std::sin(k * p[2]);
  const double cz = std::cos(k * p[2]);
  return {sx * cy + sy * cz + sz * cx, {k * (cx * cy - sz * sx), k * (cy * cz - sx * sy), k * (cz * cx - sy * sz)}};
}

// Distance to the surface F = 0: far away a lower bound (|grad F| <= sqrt(3) k), near it the distance to the tangent
// plane at the foot point, found by Newton steps along the gradient. So a sheet has the same thickness everywhere.
double gyroid_distance(const Point& p, double k, double near_mm) {
  Level level = gyroid_level(p, k);
  const double bound = std::abs(level.value) / (std::numbers::sqrt3 * k);
  if (bound > near_mm) return bound;
  Point foot = p;
  for (int step = 0; step < 4; ++step) {
    const double steep = dot(level.gradient, level.gradient);
    foot = foot - (level.value / steep) * level.gradient;
    level = gyroid_level(foot, k);
    if (step == 1) {
      // Slide along the tangent plane to the point nearest to p.
      const double norm = dot(level.gradient, level.gradient);
      foot = p - (dot(p - foot, level.gradient) / norm) * level.gradient;
      level = gyroid_level(foot, k);
    }
  }
  return std::abs(dot(p - foot, level.gradient)) / length(level.gradient);
}

}  // namespace

Field gyroid(Values v) {
  const double k = 2 * std::numbers::pi / v[0];
  const double half_sheet = v[1] / 2;
  const double radius = v[2] / 2;
  const double half = v[3] / 2;
  require(v[1] <= 0.2 * v[0],
          "--shape gyroid: sheet must not exceed 0.2 times cell (beyond it the offset surface is not smooth)");
  Field field = solid(
      [=](const Point& p) {
        const double hull = sdf::cylinder(p, radius, half);
        if (hull > half_sheet) return hull;
        return std::max(hull, gyroid_distance(p, k, 1.1 * half_sheet) - half_sheet);
      },
      {-radius, -radius, -half}, {radius, radius, half}, radius);
  field.ball_mm = std::hypot(radius, half);
  return field;
}

// The octet truss [CAL17 fig 8C]: the edges between nearest neighbours of a face-centred cubic lattice. A cell is
// mirror-symmetric about its middle planes, so one octant with the six edges of a tetrahedron says it all.
Field octet(Values v) {
  const double cell = v[0];
  const double strut = v[1] / 2;
  const double across = v[2];
  const double layers = v[3];
  require(2 * strut < 0.5 * cell, "--shape octet: strut must be below half of cell");
  const Point count{across, across, layers};
  const Point half = (0.5 * cell) * count;
  Field field = solid(
      [=](const Point& p) {
        Point q{};  // within the octant of the nearest cell, 0 ... cell / 2
        for (std::size_t a = 0; a < 3; ++a) {
          const double index = std::clamp(std::floor((p[a] + half[a]) / cell), 0.0, count[a] - 1);
          q[a] = std::abs(p[a] + half[a] - (index + 0.5) * cell);
        }
        const double h = 0.5 * cell;
        const Point corner{h, h, h};
        const Point x{h, 0, 0};
        const Point y{0, h, 0};
        const Point z{0, 0, h};
        const double to_corner =
            std::min({sdf::segment(q, corner, x), sdf::segment(q, corner, y), sdf::segment(q, corner, z)});
        const double around = std::min({sdf::segment(q, x, y), sdf::segment(q, y, z), sdf::segment(q, z, x)});
        return std::min(to_corner, around) - strut;
      },
      -1.0 * half - Point{strut, strut, strut}, half + Point{strut, strut, strut},
      std::hypot(half[0], half[1]) + strut);
  field.ball_mm = length(half) + strut;
  return field;
}

// A loose ball in a round cage of meridians and an equator [CAL17 fig 8A, CAL19 fig 2D].
Field ball_in_cage(Values v) {
  const double strut = v[1] / 2;
  const double ring = v[0] / 2 - strut;
  const double ball = v[2] / 2;
  const double meridians = v[3];  // great circles through the poles
  require(ball + strut < ring, "--shape ball-in-cage: ball touches the cage; ball must be below diameter - 2 strut");
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
      {-ring - strut, -ring - strut, -ring - strut}, {ring + strut, ring + strut, ring + strut}, ring + strut);
  field.ball_mm = ring + strut;
  return field;
}

}  // namespace vam::solid::build

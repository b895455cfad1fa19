// Lattices and the ball in a cage.
#include <numbers>

#include "solid/shapes/private/builders.hpp"
#include "solid/shapes/private/sdf.hpp"

namespace vam::solid::build {

namespace {

// The gyroid's level-set approximation F = sin x cos y + sin y cos z + sin z cos x [OST22 Methods, "Gyroid design"].
struct LevelValue {
  Point sine;
  Point cosine;

  [[nodiscard]] double value() const { return sine[0] * cosine[1] + sine[1] * cosine[2] + sine[2] * cosine[0]; }
  [[nodiscard]] Point gradient() const {  // per radian
    return {cosine[0] * cosine[1] - sine[2] * sine[0], cosine[1] * cosine[2] - sine[0] * sine[1],
            cosine[2] * cosine[0] - sine[1] * sine[2]};
  }
};

LevelValue level_at(const Point& p) {
  return {{std::sin(p[0]), std::sin(p[1]), std::sin(p[2])}, {std::cos(p[0]), std::cos(p[1]), std::cos(p[2])}};
}

// The level at a small distance d (radians) from a known one, by the addition theorem with power series: to 1e-6 for
// |d| < 1, at a tenth of the price.
LevelValue level_near(const LevelValue& at, const Point& d) {
  LevelValue moved{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double q = d[a] * d[a];
    const double s = d[a] * (1 - q / 6 * (1 - q / 20 * (1 - q / 42)));
    const double c = 1 - q / 2 * (1 - q / 12 * (1 - q / 30 * (1 - q / 56)));
    moved.sine[a] = at.sine[a] * c + at.cosine[a] * s;
    moved.cosine[a] = at.cosine[a] * c - at.sine[a] * s;
  }
  return moved;
}

// Distance in radians to the surface F = 0: far away a lower bound (|grad F| <= sqrt(3)), near it the distance to the
// tangent plane at the foot point, found by Newton steps along the gradient. So a sheet has the same thickness
// everywhere.
double gyroid_distance(const Point& p, double near) {
  const LevelValue level = level_at(p);
  const double bound = std::abs(level.value()) / std::numbers::sqrt3;
  if (bound > near) return bound;
  Point normal = level.gradient();
  Point step = (-level.value() / dot(normal, normal)) * normal;  // from p to the foot point
  for (int i = 0; i < 3; ++i) {
    const LevelValue at = level_near(level, step);
    normal = at.gradient();
    // The point nearest to p of the plane on which the linearised F vanishes.
    step = ((dot(step, normal) - at.value()) / dot(normal, normal)) * normal;
  }
  return length(step);
}

}  // namespace

Field gyroid(Values v) {
  const double k = 2 * std::numbers::pi / v[0];
  const double half_sheet = v[1] / 2;
  const double radius = v[2] / 2;
  const double half = v[3] / 2;
  require(v[1] <= 0.2 * v[0],
          "shape gyroid: sheet must not exceed 0.2 times cell (beyond it the offset surface is not smooth)");
  // Exact well beyond the sheet's surface, but not near the extrema of F (1.5), where Newton's steps go astray.
  const double near = std::min(1.6 * k * half_sheet, 1.25 / std::numbers::sqrt3);
  Field field = solid(
      [=](const Point& p) {
        const double hull = sdf::cylinder(p, radius, half);
        if (hull > half_sheet) return hull;
        return std::max(hull, gyroid_distance(k * p, near) / k - half_sheet);
      },
      {-radius, -radius, -half}, {radius, radius, half}, radius,
      1 / (0.2 * v[0] - half_sheet));  // the minimal surface bends to a radius of 0.2 cell
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

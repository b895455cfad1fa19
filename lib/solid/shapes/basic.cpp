// SPDX-License-Identifier: GPL-3.0-or-later
// Solids with volumes in closed form.
#include "base/error.hpp"
#include "solid/shapes/private/builders.hpp"
#include "solid/shapes/private/sdf.hpp"

namespace vam::solid::build {

void require(bool holds, const std::string& line) {
  if (!holds) throw Error{Fault::usage, line};
}

Field solid(std::function<double(const Point&)> value, const Point& low, const Point& high, double radius_mm,
            double curvature_per_mm) {
  Field field;
  field.some = point_by_point(std::move(value));
  field.box = {low, high};
  field.radius_mm = std::min(radius_mm, std::hypot(std::max(-low[0], high[0]), std::max(-low[1], high[1])));
  field.ball_mm = 0.5 * field.box.diagonal();
  field.curvature_per_mm = curvature_per_mm;
  return field;
}

namespace {

constexpr double least_radius = 1e-3;

Field upright(std::function<double(const Point&)> value, double radius, double half_height, double curvature_per_mm) {
  Field field = solid(std::move(value), {-radius, -radius, -half_height}, {radius, radius, half_height}, radius,
                      curvature_per_mm);
  field.ball_mm = std::hypot(radius, half_height);
  return field;
}

}  // namespace

Field sphere(Values v) {
  const double radius = v[0] / 2;
  Field field = upright([=](const Point& p) { return sdf::ball(p, radius); }, radius, radius, 1 / radius);
  field.ball_mm = radius;
  return field;
}

Field cylinder(Values v) {
  const double radius = v[0] / 2;
  const double half = v[1] / 2;
  return upright([=](const Point& p) { return sdf::cylinder(p, radius, half); }, radius, half, 1 / radius);
}

Field half_cylinder(Values v) {
  const double radius = v[0] / 2;
  const double half = v[1] / 2;
  const double flat = -radius / 2;  // the flat face, so that the part stands centred
  return solid(
      [=](const Point& p) {
        return std::max(sdf::cylinder({p[0], p[1] - flat, p[2]}, radius, half), flat - p[1]);
      },
      {-radius, flat, -half}, {radius, flat + radius, half}, std::hypot(radius, flat), 1 / radius);
}

Field hollow_cylinder(Values v) {
  const double outer = v[0] / 2;
  const double inner = v[1] / 2;
  const double half = v[2] / 2;
  require(inner < outer, "shape hollow-cylinder: inner must be below outer");
  return upright([=](const Point& p) { return sdf::tube(p, inner, outer, half); }, outer, half,
                 1 / std::max(inner, least_radius));
}

Field box(Values v) {
  const Point half{v[0] / 2, v[1] / 2, v[2] / 2};
  return solid([=](const Point& p) { return sdf::box(p, half); }, -1.0 * half, half, 1e300, 0);
}

Field cone(Values v) {
  const double bottom = v[0] / 2;
  const double top = v[1] / 2;
  const double half = v[2] / 2;
  require(bottom + top > 0, "shape cone: bottom and top cannot both be 0");
  return upright([=](const Point& p) { return sdf::frustum(p, bottom, top, half); }, std::max(bottom, top), half,
                 1 / std::max(bottom, top));
}

Field torus(Values v) {
  const double tube = v[1] / 2;
  const double ring = v[0] / 2 - tube;
  require(ring >= tube, "shape torus: tube must not exceed half of outer");
  return upright([=](const Point& p) { return sdf::torus(p, ring, tube); }, ring + tube, tube, 1 / tube);
}

// The egg shell of continuous stereolithography: the hull of two balls, hollow, with a round opening at the top [CURE19
// fig 1].
Field egg_shell(Values v) {
  const double low = v[1] / 2;
  const double high = 0.62 * low;  // the blunt and the pointed end of an egg
  const double distance = v[0] - low - high;
  const double wall = v[2];
  const double opening = v[3] / 2;
  require(distance > low - high, "shape egg-shell: length must be at least 1.01 times diameter");
  require(wall < high, "shape egg-shell: wall fills the egg; take less than 0.31 times diameter");
  require(opening <= high, "shape egg-shell: opening must be below 0.62 times diameter");
  // Profile of the hull of two balls: where its upper part has the radius r.
  const double slant = (low - high) / distance;
  const double flat = std::sqrt(1 - slant * slant);
  const double top =
      opening <= high * flat ? distance + std::sqrt(high * high - opening * opening) : (low - opening * flat) / slant;
  const double half = 0.5 * (top + low);
  const double base = low - half;  // the centre of the blunt ball
  return upright(
      [=](const Point& p) {
        const Point q{p[0], p[1], p[2] - base};
        const double skin = sdf::egg(q, low, high, distance);
        const double shell = std::max(skin, -(skin + wall));
        if (opening == 0) return shell;
        const double hole = std::max(std::hypot(p[0], p[1]) - opening, -q[2]);
        return std::max(shell, -hole);
      },
      low, half, 1 / (high - wall));
}

}  // namespace vam::solid::build

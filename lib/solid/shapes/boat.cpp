// SPDX-License-Identifier: GPL-3.0-or-later
// Parts with the difficulties of the papers' prints: thin walls, overhangs and a print around an insert.
#include <numbers>

#include "solid/shapes/private/builders.hpp"
#include "solid/shapes/private/sdf.hpp"

namespace vam::solid::build {

namespace {

// The cabin with its door and windows stands on the floor of the hull and carries the roof and the funnel; p from the
// middle of the deck, u a 20th of the length.
double superstructure(const Point& p, double u, double wall, double bottom, double roof, double funnel_top) {
  const Point c{p[0] + 1.5 * u, p[1], p[2] - 0.5 * (bottom + wall + roof)};
  const Point cabin_half{2.6 * u, 2.3 * u, 0.5 * (roof - bottom - wall)};
  const double cabin =
      std::max(sdf::box(c, cabin_half), -sdf::box(c, {2.6 * u - wall, 2.3 * u - wall, cabin_half[2] + u}));
  const double windows = std::hypot(p[0] + 1.5 * u, p[2] - 2.8 * u) - 1.3 * u;                // through both sides
  const double door = sdf::box({p[0] + 4 * u, p[1], p[2] - 1.2 * u}, {u, 1.1 * u, 2.9 * u});  // towards the stern
  const double front = sdf::box({p[0] - 1.1 * u, p[1], p[2] - 2.8 * u}, {u, 1.5 * u, 1.1 * u});
  const double house = std::max({cabin, -windows, -door, -front});
  const double top = sdf::box({p[0] + 1.5 * u, p[1], p[2] - roof + 0.5 * wall}, {3.1 * u, 2.8 * u, 0.5 * wall});
  const double height = 0.5 * (funnel_top - roof + wall);
  const double funnel =
      sdf::tube({p[0] + 2.2 * u, p[1], p[2] - (funnel_top - height)}, 0.9 * u, 0.9 * u + wall, height);
  return std::min({house, top, funnel});
}

}  // namespace

// A boat with thin walls, after the habit of printing one ([OST22 fig 5], [CURE19 fig 1]): an open hull, a cabin with
// door and windows, a roof, a funnel. The bow points to +x.
Field boat(Values v) {
  const double length_mm = v[0];
  const double wall = v[1];
  require(wall <= 0.08 * length_mm, "shape boat: wall must not exceed 0.08 times length");
  const double u = length_mm / 20;  // all other dimensions scale with the length
  const double bottom = -7 * u;
  const double deck = 0;
  const double roof = 5.2 * u;
  const double funnel_top = 7 * u;
  // The hull is where two balls overlap, cut by a flat bottom, the deck and a transom.
  const double ball = 22 * u;
  const double beam = 4.6 * u;  // half the beam at deck level
  const double stern = -7.4 * u;
  const double bow = std::sqrt(ball * ball - (ball - beam) * (ball - beam));  // where the two balls meet at deck level
  const double shift = 0.5 * (stern + bow);
  Field field = solid(
      [=](const Point& at) {
        const Point p{at[0] + shift, at[1], at[2]};
        const double sides = sdf::ball({p[0], std::abs(p[1]) + (ball - beam), p[2] - deck}, ball);
        const double outer = std::max({sides, p[2] - deck, bottom - p[2], stern - p[0]});
        const double inner = std::max({sides + wall, bottom + 1.5 * wall - p[2], stern + wall - p[0]});
        const double hull = std::max(outer, -inner);
        return std::min(hull, superstructure(p, u, wall, bottom, roof, funnel_top));
      },
      {stern - shift, -beam, bottom}, {bow - shift, beam, funnel_top}, 1e300, 1 / (0.9 * u));
  // The deck's outline is widest on the axis: its corners are at the transom.
  const double stern_half = std::sqrt(ball * ball - stern * stern) - (ball - beam);
  field.radius_mm = std::max({std::hypot(stern - shift, stern_half), bow - shift, beam});
  return field;
}

// A metal shaft with a flat tip, the thing that a handle is printed around [CAL19 fig 4].
Field screwdriver(Values v) {
  const double radius = v[0] / 2;
  const double half = v[1] / 2;
  const double blade = v[2] / 2;
  require(blade <= radius, "shape screwdriver: blade must not exceed diameter");
  return solid(
      [=](const Point& p) {
        const double shaft = sdf::cylinder(p, radius, half);
        // Two planes taper the last two diameters to the blade's thickness.
        const double taper = 4 * radius;
        const double slope = (radius - blade) / taper;
        const double plane = (std::abs(p[1]) - blade - slope * (half - p[2])) / std::hypot(1, slope);
        return std::max(shaft, plane);
      },
      {-radius, -radius, -half}, {radius, radius, half}, radius, 1 / radius);
}

// A fluted handle around such a shaft: rounded ends, bored through [CAL19 fig 4].
Field handle(Values v) {
  const double radius = v[0] / 2;
  const double half = v[1] / 2;
  const double bore = v[2] / 2;
  const double flutes = v[3];
  const double round = 0.25 * radius;
  require(bore < 0.7 * radius, "shape handle: bore must be below 0.7 times diameter");
  return solid(
      [=](const Point& p) {
        const double r = std::hypot(p[0], p[1]);
        const double body = sdf::rectangle(r, p[2], radius - round, half - round) - round;
        const double angle = std::remainder(std::atan2(p[1], p[0]), 2 * std::numbers::pi / flutes);
        // Grooves of a fifth of the radius, their middles a little outside the body.
        const double groove = std::hypot(r * std::cos(angle) - 1.08 * radius, r * std::sin(angle)) - 0.2 * radius;
        return std::max({body, -groove, bore - r});
      },
      {-radius, -radius, -half}, {radius, radius, half}, radius, 1 / (0.2 * radius));
}

}  // namespace vam::solid::build

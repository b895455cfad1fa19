// SPDX-License-Identifier: GPL-3.0-or-later
// Beams of a lattice as closed surfaces: solids of revolution, one a beam and one a ball at its ends.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/index.hpp"
#include "io/mesh/private/formats.hpp"
#include "io/mesh/private/model_part.hpp"

namespace vam::io {

namespace {

// From one end of the axis to the other: the place along it, and the distance from it.
using Profile = std::vector<std::array<double, 2>>;

// Of a sphere about a place on the axis, from quarter to quarter; as a polyhedron it has the ball's volume.
void add_arc(Profile& profile, double place, double radius, int from, int to, int sides) {
  const int steps = sides / 4;
  const double outer = radius / std::pow(std::cos(std::numbers::pi / sides), 2.0 / 3);
  for (int i = from * steps; i <= to * steps; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / steps;
    profile.push_back({place - outer * std::cos(angle), i == 2 * steps ? 0 : outer * std::sin(angle)});
  }
}

// Appends what a profile sweeps about an axis, a unit vector; its polygons have the areas of the circles.
void revolve(const Profile& profile, const Vector3& origin, const Vector3& axis, int sides, Object3mf& object) {
  Vector3 u = cross(std::abs(axis[2]) < 0.5 ? Vector3{0, 0, 1} : Vector3{1, 0, 0}, axis);
  u = (1 / length(u)) * u;
  const Vector3 v = cross(axis, u);
  const double turn = 2 * std::numbers::pi / sides;
  const double corner = std::sqrt(turn / std::sin(turn));
  const int first = count_of(object.points);
  for (const auto& [along, radius] : profile) {
    for (int side = 0; side < (radius > 0 ? sides : 1); ++side) {
      const Vector3 out = std::cos(side * turn) * u + std::sin(side * turn) * v;
      object.points.push_back(origin + along * axis + (corner * radius) * out);
    }
  }
  const int last = count_of(object.points) - 1;
  for (int side = 0; side < sides; ++side) {
    const int next = (side + 1) % sides;
    object.triangles.push_back({first, first + 1 + next, first + 1 + side});
    for (int ring = first + 1; ring + sides < last; ring += sides) {
      object.triangles.push_back({ring + side, ring + next, ring + sides + next});
      object.triangles.push_back({ring + side, ring + sides + next, ring + sides + side});
    }
    object.triangles.push_back({last, last - sides + side, last - sides + next});
  }
}

}  // namespace

void append_beams(const std::vector<Beam>& beams, Object3mf& object) {
  constexpr double some_triangles = 1 << 20;
  const double even = std::sqrt(some_triangles / static_cast<double>(beams.size() + 1));
  const int sides = std::clamp(4 * static_cast<int>(even / 4), 8, 48);
  std::set<std::pair<int, double>> balls;
  for (const auto& [from, to] : beams) {
    const Vector3 begin = object.points[from.point];
    const Vector3 way = object.points[to.point] - begin;
    const double mm = length(way);
    // At the end of a cylinder half a sphere is a whole one, which does for all beams of a point.
    const bool cone = from.radius_mm != to.radius_mm;
    for (const BeamEnd& end : {from, to})
      if (end.cap == 's' || (end.cap == 'h' && !cone)) balls.emplace(end.point, end.radius_mm);
    Profile profile;
    if (cone && from.cap == 'h') add_arc(profile, 0, from.radius_mm, 0, 1, sides);
    if (profile.empty()) profile.push_back({0, 0});
    profile.insert(profile.end(), {{0, from.radius_mm}, {mm, to.radius_mm}});
    if (cone && to.cap == 'h') add_arc(profile, mm, to.radius_mm, 1, 2, sides);
    if (profile.back()[1] > 0) profile.push_back({mm, 0});
    revolve(profile, begin, (1 / mm) * way, sides, object);
  }
  for (const auto& [point, radius_mm] : balls) {
    Profile round;
    add_arc(round, 0, radius_mm, 0, 2, sides);
    revolve(round, Vector3(object.points[point]), {0, 0, 1}, sides, object);
  }
}

}  // namespace vam::io

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/private/topology.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>

#include "base/index.hpp"
#include "base/vector3.hpp"

namespace vam::solid {

Buckets<HalfEdge> half_edges(std::span<const Triangle> triangles, std::size_t points) {
  Buckets<HalfEdge> by_low(points, [&](const auto& put) {
    for (int index = 0; index < count_of(triangles); ++index) {
      for (int side = 0; side < 3; ++side) {
        const int from = triangles[index][side];
        const int to = triangles[index][(side + 1) % 3];
        put(std::min(from, to), HalfEdge{std::max(from, to), index, side, from < to});
      }
    }
  });
  for (std::size_t low = 0; low < points; ++low)
    std::stable_sort(by_low[low].begin(), by_low[low].end(),
                     [](const HalfEdge& a, const HalfEdge& b) { return a.high < b.high; });
  return by_low;
}

void add(Measure& measure, const model::TriangleSoup& mesh, const Triangle& triangle,
         const std::array<double, 3>& origin) {
  const auto corner = [&](std::size_t c) { return mesh.points[triangle[c]] - origin; };
  const Vector3 a = corner(0);
  const Vector3 b = corner(1);
  const Vector3 c = corner(2);
  const Vector3 twice = cross(b - a, c - a);
  measure.volume += dot(a, cross(b, c)) / 6;
  measure.area += 0.5 * length(twice);
  measure.vector_area = measure.vector_area + 0.5 * twice;
}

namespace {

std::uint64_t mix(std::uint64_t x) {  // the finaliser of MurmurHash3
  x = (x ^ (x >> 33)) * 0xff51afd7ed558ccdULL;
  x = (x ^ (x >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return x ^ (x >> 33);
}

std::uint64_t hash(const Vector3& p) {
  std::uint64_t h = 0;
  for (const double c : p) h = mix(h + std::bit_cast<std::uint64_t>(c + 0.0));  // + 0.0 makes -0 equal to 0
  return h;
}

// Points get the numbers in `target`; unused numbers are closed up.
void renumber(model::TriangleSoup& mesh, std::vector<int>& target) {
  std::vector<int> number(mesh.points.size(), -1);
  std::vector<Vector3> points;
  points.reserve(mesh.points.size());
  for (Triangle& triangle : mesh.triangles) {
    for (int& corner : triangle) {
      const auto old = static_cast<std::size_t>(target[corner]);
      if (number[old] < 0) {
        number[old] = count_of(points);
        points.push_back(mesh.points[old]);
      }
      corner = number[old];
    }
  }
  mesh.points = std::move(points);
}

}  // namespace

long weld_equal_points(model::TriangleSoup& mesh) {
  const std::size_t before = mesh.points.size();
  const std::size_t slots = std::bit_ceil(2 * before + 1);
  std::vector<int> table(slots, -1);
  std::vector<int> target(before);
  long welded = 0;
  for (std::size_t i = 0; i < before; ++i) {
    std::size_t slot = hash(mesh.points[i]) & (slots - 1);
    while (table[slot] >= 0 && mesh.points[table[slot]] != mesh.points[i]) {
      slot = (slot + 1) & (slots - 1);
    }
    if (table[slot] < 0) table[slot] = static_cast<int>(i);
    target[i] = table[slot];
    if (target[i] != static_cast<int>(i)) ++welded;
  }
  renumber(mesh, target);
  return welded;
}

long weld_near_points(model::TriangleSoup& mesh, std::span<const int> candidates, double distance) {
  // Sweep along x: only candidates within `distance` in x can be near.
  std::vector<int> order(candidates.begin(), candidates.end());
  const auto point = [&](int index) -> const Vector3& { return mesh.points[index]; };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return point(a) < point(b); });
  std::vector<int> target(mesh.points.size());
  std::iota(target.begin(), target.end(), 0);
  long welded = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (target[order[i]] != order[i]) continue;  // has joined another
    for (std::size_t j = i + 1; j < order.size() && point(order[j])[0] - point(order[i])[0] <= distance; ++j) {
      int& joined = target[order[j]];
      if (joined != order[j] || length(point(order[j]) - point(order[i])) > distance) continue;
      joined = order[i];
      ++welded;
    }
  }
  renumber(mesh, target);
  return welded;
}

long drop_degenerate(model::TriangleSoup& mesh) {
  return static_cast<long>(
      std::erase_if(mesh.triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }));
}

}  // namespace vam::solid

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/private/topology.hpp"

#include <algorithm>

#include "base/vector3.hpp"

namespace vam::solid {

EdgeTable::EdgeTable(std::span<const Triangle> triangles, std::size_t points) : first_(points + 1) {
  // Counting sort by the lower index, then each short bucket by the higher one.
  const auto low_of = [](const Triangle& t, std::size_t side) {
    return static_cast<std::size_t>(std::min(t[side], t[(side + 1) % 3]));
  };
  for (const Triangle& t : triangles) {
    for (std::size_t side = 0; side < 3; ++side) ++first_[low_of(t, side) + 1];
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  half_edges_.resize(first_.back());
  for (std::size_t index = 0; index < triangles.size(); ++index) {
    const Triangle& t = triangles[index];
    for (std::size_t side = 0; side < 3; ++side) {
      const int from = t[side];
      const int to = t[(side + 1) % 3];
      half_edges_[next[low_of(t, side)]++] = {std::max(from, to), static_cast<int>(index), static_cast<int>(side),
                                              from < to};
    }
  }
  for (std::size_t low = 0; low < points; ++low) {
    const auto begin = half_edges_.begin() + static_cast<std::ptrdiff_t>(first_[low]);
    const auto end = half_edges_.begin() + static_cast<std::ptrdiff_t>(first_[low + 1]);
    std::stable_sort(begin, end, [](const HalfEdge& a, const HalfEdge& b) { return a.high < b.high; });
  }
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

}  // namespace vam::solid

// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles cut to voxels: polygons in voxel units, voxel i spanning i ... i + 1 along every axis.
#pragma once

#include <algorithm>
#include <array>

#include "base/index.hpp"
#include "base/vector3.hpp"

namespace vam::solid {

/// A convex polygon in a plane. A triangle cut by six planes has at most nine corners; slivers that rounding has made
/// slightly concave may have more, and lose what exceeds the room (their area is that of rounding).
struct Polygon {
  static constexpr int room = 16;
  std::array<Vector3, room> corners;
  int count = 0;

  Polygon() {}  // NOLINT: corners beyond count are never read
  Polygon(const Polygon& other) : count(other.count) { std::copy_n(other.corners.begin(), count, corners.begin()); }
  Polygon& operator=(const Polygon& other) {
    count = other.count;
    std::copy_n(other.corners.begin(), count, corners.begin());
    return *this;
  }
  void add(const Vector3& p) {
    if (count < room) corners[count++] = p;
  }
};

/// Cuts at coordinate `axis` = plane into what is below and what is above; either may come out empty. A cut edge gives
/// the same point whichever triangle it is met in, so shared edges stay shared to the last bit.
inline void split(const Polygon& polygon, std::size_t axis, double plane, Polygon& below, Polygon& above) {
  below.count = 0;
  above.count = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const Vector3& p = polygon.corners[i];
    const Vector3& q = polygon.corners[i + 1 == polygon.count ? 0 : i + 1];
    if (p[axis] <= plane) below.add(p);
    if (p[axis] >= plane) above.add(p);
    if ((p[axis] < plane && q[axis] > plane) || (p[axis] > plane && q[axis] < plane)) {
      const Vector3& low = p[axis] < plane ? p : q;
      const Vector3& high = p[axis] < plane ? q : p;
      const double t = (plane - low[axis]) / (high[axis] - low[axis]);
      Vector3 cut = low + t * (high - low);
      cut[axis] = plane;
      below.add(cut);
      above.add(cut);
    }
  }
}

/// Voxels along one axis that a polygon meets, first ... last, within 0 ... size - 1. A face between two voxels belongs
/// to the upper one.
struct Span {
  int first;
  int last;
};
[[nodiscard]] inline Span span_of(double low, double high, int size) {
  const int first = std::clamp(floor_int(low), 0, size - 1);
  const int last = std::clamp(ceil_int(high) - 1, first, size - 1);
  return {first, last};
}
[[nodiscard]] inline Span span_of(const Polygon& polygon, std::size_t axis, int size) {
  double low = polygon.corners[0][axis];
  double high = low;
  for (int i = 1; i < polygon.count; ++i) {
    const double c = polygon.corners[i][axis];
    low = std::min(low, c);
    high = std::max(high, c);
  }
  return span_of(low, high, size);
}

/// Calls visit(index, piece) for the piece of the polygon in each voxel layer along `axis`, ascending.
template <typename Visit>
void for_each_layer(const Polygon& polygon, std::size_t axis, int size, const Visit& visit) {
  const Span span = span_of(polygon, axis, size);
  if (span.first == span.last) return visit(span.first, polygon);
  Polygon piece;
  std::array<Polygon, 2> rest;  // by turns
  const Polygon* whole = &polygon;
  std::size_t turn = 0;
  for (int i = span.first; i < span.last && whole->count >= 3; ++i, turn ^= 1U) {
    split(*whole, axis, i + 1, piece, rest[turn]);
    if (piece.count >= 3) visit(i, piece);
    whole = &rest[turn];
  }
  if (whole->count >= 3) visit(span.last, *whole);
}

/// The piece within layer `index` along `axis`, cut from the polygon itself and not from a remainder.
[[nodiscard]] inline Polygon layer(const Polygon& polygon, std::size_t axis, int index, int size) {
  const Span span = span_of(polygon, axis, size);
  if (span.first == span.last) return polygon;
  Polygon dropped;
  Polygon upper;
  if (index > span.first) {
    split(polygon, axis, index, dropped, upper);
    if (index == span.last) return upper;
  }
  Polygon piece;
  split(index > span.first ? upper : polygon, axis, index + 1, piece, dropped);
  return piece;
}

}  // namespace vam::solid

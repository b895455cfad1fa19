// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes and affine maps in mm: what meshes and implicit shapes have in common.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "base/vector3.hpp"
#include "model/mesh.hpp"

namespace vam::solid {

using Point = Vector3;

/// An axis-aligned box; empty when low > high.
struct Bounds {
  Point low{std::numeric_limits<double>::max(), std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  Point high{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::lowest(),
             std::numeric_limits<double>::lowest()};

  void add(const Point& p) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
  }
  void join(const Bounds& other) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], other.low[a]);
      high[a] = std::max(high[a], other.high[a]);
    }
  }
  [[nodiscard]] Point size() const { return high - low; }
  [[nodiscard]] double largest_side() const { return std::max({size()[0], size()[1], size()[2]}); }
  [[nodiscard]] Point centre() const { return 0.5 * (low + high); }
  [[nodiscard]] double diagonal() const { return length(size()); }
  [[nodiscard]] bool contains(const Point& p) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (p[a] < low[a] || p[a] > high[a]) return false;
    }
    return true;
  }
  [[nodiscard]] bool contains(const Bounds& other) const { return contains(other.low) && contains(other.high); }
  /// They share a point at least.
  [[nodiscard]] bool meets(const Bounds& other) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (low[a] > other.high[a] || high[a] < other.low[a]) return false;
    }
    return true;
  }
};

/// Of the corners of all triangles.
[[nodiscard]] Bounds bounding_box(const model::TriangleSoup& mesh);
[[nodiscard]] double area_of(const model::TriangleSoup& mesh);

/// p -> linear * p + shift.
struct Affine {
  std::array<Point, 3> linear{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};  // rows
  Point shift{};

  [[nodiscard]] Point operator()(const Point& p) const {
    return {dot(linear[0], p) + shift[0], dot(linear[1], p) + shift[1], dot(linear[2], p) + shift[2]};
  }
  /// First b, then a.
  [[nodiscard]] friend Affine operator*(const Affine& a, const Affine& b) { return a.after(b); }

  [[nodiscard]] Affine after(const Affine& b) const;
};

/// Scales by s about the origin.
[[nodiscard]] Affine scaling(const Point& s);
/// Turns about x, then y, then z (fixed axes), right-handed, degrees.
[[nodiscard]] Affine rotation(const Point& xyz_deg);
/// The inverse map; the linear part must not be singular.
[[nodiscard]] Affine inverse(const Affine& a);

}  // namespace vam::solid

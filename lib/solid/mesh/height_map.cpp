// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/height_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "solid/mesh/geometry.hpp"
#include "solid/mesh/private/triangle_tree.hpp"

namespace vam::solid {

namespace {

// Twice the signed area of a, b, p in the plane.
double edge(const Vector3& a, const Vector3& b, double x, double y) {
  return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

// Raises the pixels that a triangle covers, by barycentric coordinates of their middles.
void raise(const TriangleCorners& t, HeightMap& map) {
  const double area = edge(t[0], t[1], t[2][0], t[2][1]);
  if (area == 0) return;  // upright: its edges belong to its neighbours
  const auto [low_x, high_x] = std::minmax({t[0][0], t[1][0], t[2][0]});
  const auto [low_y, high_y] = std::minmax({t[0][1], t[1][1], t[2][1]});
  const auto column = [&](double x) { return (x - map.x_mm) / map.pixel_mm; };
  const auto row = [&](double y) { return (map.y_mm - y) / map.pixel_mm; };
  for (int j = ceil_int(row(high_y)); j <= floor_int(row(low_y)); ++j) {
    for (int i = ceil_int(column(low_x)); i <= floor_int(column(high_x)); ++i) {
      const double x = map.x_mm + i * map.pixel_mm;
      const double y = map.y_mm - j * map.pixel_mm;
      const double a = edge(t[1], t[2], x, y) / area;
      const double b = edge(t[2], t[0], x, y) / area;
      const double c = 1 - a - b;
      constexpr double rounding = -1e-9;  // a pixel on an edge belongs to both sides
      if (a < rounding || b < rounding || c < rounding) continue;
      const auto z = static_cast<float>(a * t[0][2] + b * t[1][2] + c * t[2][2]);
      float& height = map.heights_mm(i, j);
      if (!(height >= z)) height = z;
    }
  }
}

}  // namespace

HeightMap height_map(const model::TriangleSoup& mesh, double pixel_mm) {
  const Bounds box = bounding_box(mesh);
  const double width = std::ceil((box.high[0] - box.low[0]) / pixel_mm) + 3;
  const double height = std::ceil((box.high[1] - box.low[1]) / pixel_mm) + 3;
  if (!(width * height <= 1e8)) {
    throw Error{Fault::data, "height map: " + format_number(width) + " x " + format_number(height) + " pixels of " +
                                 format_number(pixel_mm) + " mm exceed the limit; use a larger pixel"};
  }
  HeightMap map{Image(static_cast<int>(width), static_cast<int>(height), std::numeric_limits<float>::quiet_NaN()),
                pixel_mm, 0.5 * (box.low[0] + box.high[0] - (width - 1) * pixel_mm),
                0.5 * (box.low[1] + box.high[1] + (height - 1) * pixel_mm)};
  for (const TriangleCorners& triangle : corners_of(mesh)) raise(triangle, map);
  return map;
}

}  // namespace vam::solid

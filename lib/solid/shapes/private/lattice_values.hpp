// SPDX-License-Identifier: GPL-3.0-or-later
// A field at the points of a small cubic lattice.
#pragma once

#include <array>
#include <cstddef>

#include "solid/shapes/field.hpp"

namespace vam::solid {

/// side^3 values, x fastest, at origin + step_mm * (first + i, first + j, first + k).
template <std::size_t side>
[[nodiscard]] std::array<double, side * side * side> lattice_values(const Field& field, const Point& origin,
                                                                    double first, double step_mm) {
  std::array<Point, side * side * side> points;
  auto* point = points.data();
  for (std::size_t k = 0; k < side; ++k) {
    for (std::size_t j = 0; j < side; ++j) {
      for (std::size_t i = 0; i < side; ++i) {
        *point++ = origin + step_mm * Point{first + static_cast<double>(i), first + static_cast<double>(j),
                                            first + static_cast<double>(k)};
      }
    }
  }
  std::array<double, side * side * side> values;
  values_at(field, points, values.data());
  return values;
}

}  // namespace vam::solid

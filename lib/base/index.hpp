// SPDX-License-Identifier: GPL-3.0-or-later
// Whole numbers from sizes and from real numbers: indices and counts are int, places in large arrays std::size_t.
#pragma once

#include <cmath>
#include <cstddef>
#include <iterator>

namespace vam {

/// Number of elements.
template <class Container>
[[nodiscard]] constexpr int count_of(const Container& elements) {
  return static_cast<int>(std::size(elements));
}

/// A product beyond the range of int.
[[nodiscard]] constexpr std::size_t product(std::size_t a, std::size_t b) { return a * b; }

/// Where an element of a row-major array lies.
[[nodiscard]] constexpr std::size_t flat_index(std::size_t row, std::size_t width, std::size_t column) {
  return row * width + column;
}

/// The whole number at or below, at or above, and nearest to a value within the range of int; halves away from 0.
[[nodiscard]] inline int floor_int(double value) { return static_cast<int>(std::floor(value)); }
[[nodiscard]] inline int ceil_int(double value) { return static_cast<int>(std::ceil(value)); }
[[nodiscard]] inline int round_int(double value) { return static_cast<int>(std::lround(value)); }

}  // namespace vam

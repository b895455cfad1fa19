// SPDX-License-Identifier: GPL-3.0-or-later
// The places of an array in one loop.
#pragma once

#include <array>
#include <cstddef>

template <std::size_t N>
struct Indices {
  std::array<int, N> sizes;

  struct Iterator {
    std::array<int, N> sizes, place;
    std::array<int, N> operator*() const { return place; }
    Iterator& operator++() {
      ++place.back();
      for (std::size_t axis = N - 1; axis > 0 && place[axis] == sizes[axis]; --axis) {
        place[axis] = 0;
        ++place[axis - 1];
      }
      return *this;
    }
    bool operator!=(const Iterator& other) const { return place[0] != other.place[0]; }
  };

  [[nodiscard]] Iterator begin() const {
    for (const int size : sizes) {
      if (size == 0) return end();
    }
    return {sizes, {}};
  }
  [[nodiscard]] Iterator end() const { return {sizes, {sizes[0]}}; }
};

/// for (const auto [k, j, i] : indices(slices, rows, columns)): 0, 0, 0; 0, 0, 1; ... with the last one fastest.
template <class... Size>
Indices<sizeof...(Size)> indices(Size... sizes) {
  return {{static_cast<int>(sizes)...}};
}

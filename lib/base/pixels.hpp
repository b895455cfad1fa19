// SPDX-License-Identifier: GPL-3.0-or-later
// Images of whole numbers, as files, screens and projectors have them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vam {

/// Grey levels 0 .. 2^bits - 1, row-major from the top left; bits is 1, 2, 4, 8, 10 or 16.
struct GreyImage {
  int width = 0;
  int height = 0;
  int bits = 8;
  std::vector<std::uint16_t> values;

  GreyImage() = default;
  GreyImage(int columns, int rows, int depth)
      : width(columns), height(rows), bits(depth), values(static_cast<std::size_t>(columns) * rows) {}

  [[nodiscard]] std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
  std::uint16_t& operator()(int x, int y) { return values[index(x, y)]; }
  std::uint16_t operator()(int x, int y) const { return values[index(x, y)]; }
  [[nodiscard]] int full() const { return (1 << bits) - 1; }
  bool operator==(const GreyImage&) const = default;
};

using Rgb = std::array<std::uint8_t, 3>;

/// 8-bit colours, row-major from the top left.
struct RgbImage {
  int width = 0;
  int height = 0;
  std::vector<Rgb> values;

  RgbImage() = default;
  RgbImage(int columns, int rows, Rgb fill = {0, 0, 0})
      : width(columns), height(rows), values(static_cast<std::size_t>(columns) * rows, fill) {}

  [[nodiscard]] std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
  Rgb& operator()(int x, int y) { return values[index(x, y)]; }
  const Rgb& operator()(int x, int y) const { return values[index(x, y)]; }
};

/// Part of an image, from its left and uppermost pixel.
struct PixelRect {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

}  // namespace vam

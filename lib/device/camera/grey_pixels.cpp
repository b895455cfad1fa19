// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/private/grey_pixels.hpp"

#include <algorithm>

namespace vam::device {

namespace {

std::uint16_t spread(unsigned value, int bits) {
  if (bits == 16) return static_cast<std::uint16_t>(value);
  const int shift = 16 - bits;
  const unsigned top = (1U << bits) - 1;
  value = std::min(value, top);
  return static_cast<std::uint16_t>(value << shift | value >> (bits - shift));
}

}  // namespace

bool to_grey(std::span<const std::uint8_t> from, int columns, int rows, std::size_t stride, PixelLayout layout,
             int bits, GreyImage& to) {
  to = GreyImage(columns, rows, layout == PixelLayout::words ? 16 : 8);
  const auto width = static_cast<std::size_t>(columns);
  const std::size_t pixel = layout == PixelLayout::bytes ? 1 : 2;
  const std::size_t first = layout == PixelLayout::odd_bytes ? 1 : 0;
  stride = std::max(stride, width * pixel);
  for (std::size_t y = 0; y < static_cast<std::size_t>(rows); ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t at = y * stride + x * pixel;
      if (at + pixel > from.size()) return false;
      to.values[y * width + x] = layout == PixelLayout::words
                                     ? spread(from[at] | static_cast<unsigned>(from[at + 1]) << 8, bits)
                                     : from[at + first];
    }
  }
  return true;
}

void widen_luma(GreyImage& levels) {
  constexpr int black = 16;
  constexpr int range = 219;
  for (auto& level : levels.values) {
    const int above = std::clamp(level - black, 0, range);
    level = static_cast<std::uint16_t>((255 * above + range / 2) / range);
  }
}

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// Pixels as cameras send them, as grey levels of 8 or 16 bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/pixels.hpp"

namespace vam::device {

enum class PixelLayout {
  bytes,       // 8 bits
  even_bytes,  // every second byte (YUYV: luma)
  odd_bytes,   // likewise from the second on (UYVY)
  words,       // 16 bits little-endian, the value in the low `bits`
};

/// Rows of `stride` bytes (0: close together). 10 and 12 bits are spread over 16, so that full stays full: v << s |
/// v >> (bits - s). False when there are too few bytes; what is missing is 0.
bool to_grey(std::span<const std::uint8_t> from, int columns, int rows, std::size_t stride, PixelLayout layout,
             int bits, GreyImage& to);

/// Luma of limited range (ITU-R BT.601: black is 16, full 235) as levels from 0 to 255.
void widen_luma(GreyImage& levels);

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
// A TIFF of several pages as numbers: slices of a volume or projections, of whole numbers or floats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace vam::io {

struct TiffPages {
  std::uint32_t pages = 0, rows = 0, columns = 0;
  char kind = 'u';      // u, i or f
  int value_bytes = 1;  // 1, 2, 4 or 8
};

/// Pages of one size and type; grey, one sample a pixel, in strips. What it returns copies the values of all pages, row
/// by row, in this machine's byte order; fewer than `size` bytes only at the end. Both throw std::runtime_error, to
/// stand behind the file's name.
[[nodiscard]] std::function<std::size_t(void* to, std::size_t size)> open_tiff_pages(std::string bytes,
                                                                                     TiffPages& about);

}  // namespace vam::io

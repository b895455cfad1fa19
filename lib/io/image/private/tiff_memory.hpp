// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the image files: libtiff on bytes in memory.
#pragma once

#include <tiffio.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace vam::io {

struct TiffMemory {
  std::string bytes;
  std::size_t at = 0;
};

using Tiff = std::unique_ptr<TIFF, void (*)(TIFF*)>;

/// Reads; `file` must outlive it. Null where libtiff finds no TIFF. It prints nothing.
[[nodiscard]] Tiff open_tiff(TiffMemory& file);

template <class Value = std::uint16_t>
Value tiff_field(TIFF* tiff, std::uint32_t tag) {
  Value value{};
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

/// Rows from the top, columns from the left, as it is without a statement.
inline bool is_upright(TIFF* tiff) {
  const auto orientation = tiff_field(tiff, TIFFTAG_ORIENTATION);
  return orientation == 0 || orientation == ORIENTATION_TOPLEFT;
}

/// Upright, or only mirrored or turned by 180 degrees, which libtiff undoes in images of 8 bits.
inline bool has_rows(TIFF* tiff) { return tiff_field(tiff, TIFFTAG_ORIENTATION) <= ORIENTATION_BOTLEFT; }

}  // namespace vam::io

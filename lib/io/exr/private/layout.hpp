// SPDX-License-Identifier: GPL-3.0-or-later
// The form of a part: its size, channels and chunks, checked before anything is believed.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <cstddef>
#include <string>

namespace vam::io::exr {

struct Layout {
  Imf::Header header;  // window, channels, compression, line order
  std::string key;     // the same, serialized: parts of equal keys share one Layout
  int width = 0;
  int height = 0;
  int chunks = 0;
  std::size_t max_chunk_bytes = 0;  // OpenEXR stores a chunk uncompressed where compression does not help
};

/// Throws std::runtime_error with what cannot be read: tiles, sizes beyond max_side and max_pixels, subsampled
/// channels, no channel Y, an unknown compression.
[[nodiscard]] Layout checked_layout(const Imf::Header& part);

}  // namespace vam::io::exr

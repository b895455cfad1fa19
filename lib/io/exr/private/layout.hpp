// SPDX-License-Identifier: GPL-3.0-or-later
// The form of a part, its size, channels and chunks, checked before anything is believed, and the values that it may
// have.
#pragma once

#include <OpenEXR/ImfHeader.h>

#include <cstddef>
#include <string>

#include "base/image.hpp"
#include "model/stack.hpp"

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

/// "pixel 3, 4 of image 2 is 1e+30, more than 1e9, ..." of the first value that is not finite, or of projections is no
/// intensity; empty where there is none.
[[nodiscard]] std::string objection(const Image& image, std::size_t index, model::Space space);

}  // namespace vam::io::exr

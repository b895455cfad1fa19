// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the EXR files: rows of one channel, as they are or by RLE, without OpenEXR, which takes seven times as
// long for what is mostly dark.
#pragma once

#include "base/image.hpp"
#include "io/exr/private/format.hpp"

namespace vam::io::exr {

/// Whether a chunk is a row of one channel of floats or halves that decode_rows() knows.
[[nodiscard]] bool has_plain_rows(const Imf::Header& layout);

/// decode() of such an image. Throws std::runtime_error for a row of another size.
void decode_rows(const Imf::Header& layout, const Chunks& chunks, Image& image);

}  // namespace vam::io::exr

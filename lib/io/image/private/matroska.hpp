// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the video files: what a Matroska file says of its own wholeness.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "io/stream/seal.hpp"

namespace vam::io {

/// What of a file speaks for its wholeness.
struct MatroskaProof {
  bool checksums = false;      // its parts have some, and all are right
  std::optional<Digest> seal;  // that these tools wrote; not held to the frames yet
};

/// Throws Fault::data where a Matroska file is shorter than its segment, or where one of the checksums that its parts
/// begin with is wrong (CRC-32, RFC 8794 section 11.3.1; a part without one among parts that have one is damaged, too,
/// as are bytes behind them, and a part of a kind that Matroska does not have). libav checks neither, and takes the end
/// of a cut file for the end of the film. Nothing speaks for files of other kinds.
MatroskaProof require_whole_matroska(const std::string& path);

/// Where the eight bytes of the size of the segment begin in the first bytes of a Matroska file; nothing where the size
/// is not known, or kept in fewer.
[[nodiscard]] std::optional<std::size_t> segment_size_at(const std::string& head);

}  // namespace vam::io

// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the video files: what a Matroska file says of its own wholeness.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "base/pixels.hpp"
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

inline constexpr const char* video_version = "VAM_VERSION";  // a tag of the file

/// Takes what the frames of a video are decoded to, one after the other.
class VideoSeal {
 public:
  /// version: the text of the tag VAM_VERSION; facts: VideoFormat::facts; empty: there is none.
  VideoSeal(int width, int height, int bits, const std::string& version, const std::string& facts);
  /// The hash of one frame, which many threads may take at once.
  [[nodiscard]] static Digest of(const GreyImage& frame);
  void add(const Digest& frame);
  [[nodiscard]] Digest digest() const;
  [[nodiscard]] std::int64_t frames() const { return frames_; }

 private:
  Sealer all_;
  std::int64_t frames_ = 0;
};

/// A Tags element that holds the tag VAM_SEAL alone, with its CRC-32 (RFC 9559 section 5.1.8).
[[nodiscard]] std::string seal_element(const Digest& digest);
/// What such an element holds, by its content; nothing for that of other tags.
[[nodiscard]] std::optional<Digest> parse_seal_element(const std::string& content);
/// Bytes of the content of such an element.
[[nodiscard]] std::size_t seal_element_bytes();

}  // namespace vam::io

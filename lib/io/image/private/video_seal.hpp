// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the video files: the seal of a lossless video, over its decoded levels, in a Tags element of Matroska at
// the end of the file. Checksums of container and slices tell that bytes are those that some program wrote; this tells
// that the levels and the facts are those that these tools wrote.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/pixels.hpp"
#include "io/stream/seal.hpp"

namespace vam::io {

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

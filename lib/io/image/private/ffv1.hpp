// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the video writer: FFV1 frames of 8 grey bits, by Golomb-Rice codes RFC 9043.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/pixels.hpp"

namespace vam::io {

using Bytes = std::vector<std::uint8_t>;

/// Appends the codes of a slice of an image of up to 8 bits, whose full level becomes 255. What is dark around the
/// light costs an eighth of a look at each pixel: libavcodec spends 5 ns on it.
void append_ffv1_codes(const GreyImage& image, const PixelRect& slice, Bytes& codes);

/// Makes the packets that libavcodec's encoder makes, each frame alone, so that frames can be encoded side by side.
/// Version 3, 2 x 2 slices with checksums, every frame a key frame.
class Ffv1Frames {
 public:
  /// The checksum that ends a slice.
  using Checksum = std::uint32_t (*)(const std::uint8_t* bytes, std::size_t count);

  /// What an encoder should be tried with: pixels that use all contexts and every kind of code.
  [[nodiscard]] static GreyImage trial(int width, int height);

  /// From the packet that the encoder made of trial(); what precedes the codes of a slice is the same in every frame.
  /// Nothing if the packet is not what this would make, as another release of the library may have it.
  [[nodiscard]] static std::optional<Ffv1Frames> like(const Bytes& packet, int width, int height, Checksum checksum);

  /// For images of another size of at least 4 x 4: what precedes the codes tells places in halves of an image, not in
  /// pixels.
  void resize(int width, int height);

  /// Many threads may ask at once.
  [[nodiscard]] Bytes packet(const GreyImage& image) const;

 private:
  struct Part {
    PixelRect place;
    Bytes head;
  };
  Ffv1Frames(int width, int height, Checksum checksum);
  void append(const Part& part, const GreyImage& image, Bytes& packet) const;

  Checksum checksum_;
  std::vector<Part> parts_;
};

}  // namespace vam::io

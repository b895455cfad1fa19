// Private to the video writer: FFV1 frames of 8 grey bits, by Golomb-Rice codes [RFC 9043].
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/pixels.hpp"

namespace vam::io {

using Bytes = std::vector<std::uint8_t>;

/// Appends the codes of a slice's pixels, width x height of them in rows that are `stride` apart. What is dark around
/// the light costs an eighth of a look at each pixel: libavcodec spent 5 ns on it.
void append_ffv1_codes(const std::uint8_t* pixels, std::ptrdiff_t stride, int width, int height, Bytes& codes);

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

  /// `pixels` are width x height without gaps. Many threads may ask at once.
  [[nodiscard]] Bytes packet(const std::uint8_t* pixels) const;

 private:
  struct Part {
    int x = 0, y = 0, width = 0, height = 0;
    Bytes head;
  };
  Ffv1Frames(int width, int height, Checksum checksum);
  [[nodiscard]] Bytes codes(const Part& part, const std::uint8_t* pixels) const;
  void append(const Part& part, const std::uint8_t* pixels, Bytes& packet) const;

  int width_;
  Checksum checksum_;
  std::vector<Part> parts_;
};

}  // namespace vam::io

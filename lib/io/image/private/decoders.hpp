// SPDX-License-Identifier: GPL-3.0-or-later
// Images of the formats that cameras and slicers write, from memory.
#pragma once

#include <cstdint>
#include <string>

#include "base/pixels.hpp"

namespace vam::io {

/// 8 or 16 grey bits, as read_image() says. Throw Error{data} that begins with `name`.
[[nodiscard]] GreyImage decode_png(const std::string& bytes, const std::string& name);
[[nodiscard]] GreyImage decode_tiff(const std::string& bytes, const std::string& name);

inline constexpr std::uint64_t max_pixels = std::uint64_t{1} << 28;  // of an image

/// "a.png: is 100000 x 100000 pixels; images of up to 2^28 can be read"
[[nodiscard]] inline std::string too_large(const std::string& name, std::uint32_t width, std::uint32_t height) {
  return name + ": is " + std::to_string(width) + " x " + std::to_string(height) +
         " pixels; images of up to 2^28 can be read";
}

/// ITU-R BT.601, in 16 bits.
[[nodiscard]] constexpr int luma(std::uint32_t red, std::uint32_t green, std::uint32_t blue) {
  return static_cast<int>((19595 * red + 38470 * green + 7471 * blue + 32768) >> 16);
}

}  // namespace vam::io

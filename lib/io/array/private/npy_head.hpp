// Private to the array files: the header of a NumPy file (numpy.lib.format, versions 1.0 to 3.0).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace vam::io::npy {

inline constexpr std::string_view magic = "\x93NUMPY";
inline constexpr std::size_t start_bytes = 8;             // magic and version; the length of the header text follows
inline constexpr std::uint64_t most_text = 1 << 16;       // bytes of header text
inline constexpr std::uint64_t most_side = 1 << 16;       // values along an axis
inline constexpr std::uint64_t most_image = 1ULL << 28;   // values of a slice
inline constexpr std::uint64_t most_values = 1ULL << 40;  // of all

/// The type of its values and their order.
struct Head {
  char kind = 'f';  // b, i, u or f
  int bytes = 4;    // of a value: 1, 2, 4 or 8
  bool big_endian = false;
  bool fortran = false;                  // the first axis is the fastest
  std::array<std::uint64_t, 3> shape{};  // a plane is one slice
  [[nodiscard]] std::uint64_t values() const { return shape[0] * shape[1] * shape[2]; }
};

/// From the header text. Throws std::runtime_error, to stand behind the file's name: not numbers (Python objects, text,
/// records, complex), not 2 or 3 axes, an empty axis, sizes beyond the limits, no such text.
[[nodiscard]] Head parse_head(std::string_view text);

/// Magic, version 1.0 and header text of little-endian floats in C order, as NumPy pads them.
[[nodiscard]] std::string head_of_floats(const std::array<int, 3>& shape);

}  // namespace vam::io::npy

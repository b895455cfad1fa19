// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: the header of a NumPy file (numpy.lib.format, versions 1.0 to 3.0).
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "io/array/private/array_bytes.hpp"
#include "io/array/private/array_head.hpp"

namespace vam::io::arrays {

inline constexpr std::string_view npy_magic = "\x93NUMPY";

/// Throws std::runtime_error: not such a file, and as parse_npy_head().
[[nodiscard]] Head take_npy_head(Bytes& bytes);

/// From the header text. Throws std::runtime_error, to stand behind the file's name: not numbers (Python objects, text,
/// records, complex), a shape that is not read, no such text.
[[nodiscard]] Head parse_npy_head(std::string_view text);

/// Magic, version 1.0 and header text of little-endian floats in C order, as NumPy pads them.
[[nodiscard]] std::string head_of_floats(const std::array<int, 3>& shape);

}  // namespace vam::io::arrays

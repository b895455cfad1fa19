// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: the header of an MRC2014 file, as electron and X-ray microscopes write them.
#pragma once

#include <cstddef>
#include <string_view>

#include "io/array/private/array_bytes.hpp"
#include "io/array/private/array_head.hpp"

namespace vam::io::arrays {

inline constexpr std::size_t mrc_magic_at = 208;
inline constexpr std::string_view mrc_magic = "MAP ";

/// The bytes that follow are the values. Throws Fault::data: not such a file, complex or packed values, axes in another
/// order than x, y, z.
[[nodiscard]] Head take_mrc_head(Bytes& bytes);

}  // namespace vam::io::arrays

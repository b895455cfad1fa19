// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: the header of an NRRD file (teem, versions 1 to 5), its values in the same file.
#pragma once

#include <string_view>

#include "io/array/private/array_bytes.hpp"
#include "io/array/private/array_head.hpp"

namespace vam::io::arrays {

inline constexpr std::string_view nrrd_magic = "NRRD000";

/// The bytes that follow are the values, unpacked where they are packed. Throws Fault::data: not such a file, a field
/// that is missing or not understood, values in another file, text or bzip2, other than scalars.
[[nodiscard]] Head take_nrrd_head(Bytes& bytes);

}  // namespace vam::io::arrays

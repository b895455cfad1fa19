// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: the header of an NRRD file (teem, versions 1 to 5), its values in the same file.
#pragma once

#include <string_view>
#include <vector>

#include "io/array/private/array_bytes.hpp"
#include "io/array/private/array_head.hpp"

namespace vam::io::arrays {

inline constexpr std::string_view nrrd_magic = "NRRD000";

/// The bytes that follow are the values, unpacked where they are packed. Throws Fault::data: not such a file, a field
/// that is missing or not understood, values in another file, text or bzip2, other than scalars. voxel_mm: the edges
/// that it states (spacings or space directions), along its own axes, the fastest first; in mm where it names no unit.
/// Empty where it states none for every axis, or in a unit that is no length. Also Fault::data: axes that its space
/// directions state to be oblique, or reversed, or, without `ordered` (an order of the axes that was asked for), to be
/// others than x, y and z, the fastest first.
[[nodiscard]] Head take_nrrd_head(Bytes& bytes, std::vector<double>& voxel_mm, bool ordered = false);

}  // namespace vam::io::arrays

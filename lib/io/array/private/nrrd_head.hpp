// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: the header of an NRRD file as write_nrrd() writes it.
#pragma once

#include <string_view>

#include "io/array/private/array_bytes.hpp"
#include "io/array/private/array_head.hpp"

namespace vam::io::arrays {

inline constexpr std::string_view nrrd_magic = "NRRD000";

/// The bytes that follow are the values, floats or bytes. voxel_mm: the edge of the cubes along x, y and z that it
/// states; 0: none. Throws std::runtime_error: not such a file, other fields or values.
[[nodiscard]] Head take_nrrd_head(Bytes& bytes, double& voxel_mm);

}  // namespace vam::io::arrays

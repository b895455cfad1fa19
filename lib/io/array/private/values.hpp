// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the array files: numbers of any type as floats.
#pragma once

#include <cstddef>

#include "io/array/private/array_head.hpp"

namespace vam::io::arrays {

/// `count` values of the head's type as floats; what is too large for a float becomes infinite.
void to_floats(const Head& head, const char* bytes, std::size_t count, float* to);

}  // namespace vam::io::arrays

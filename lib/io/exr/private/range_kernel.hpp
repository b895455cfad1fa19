// SPDX-License-Identifier: GPL-3.0-or-later
// Private to intensities.cpp: whether values are in range, for the instruction set of the machine.
#pragma once

#include <cstddef>

namespace vam::io::exr {

/// Whether all of them are in [low, high]; one that is not a number is not.
using AllWithin = bool (*)(const float* values, std::size_t count, float low, float high);

namespace baseline {
extern const AllWithin all_within;
}
namespace avx2 {
extern const AllWithin all_within;
}
namespace avx512 {
extern const AllWithin all_within;
}

}  // namespace vam::io::exr

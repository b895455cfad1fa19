// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/exr/private/range_kernel.hpp"

namespace vam::io::exr::VAM_SIMD {

namespace {

bool within(const float* values, std::size_t count, float low, float high) {
  unsigned good = 1;
  for (std::size_t i = 0; i < count; ++i) {  // no early exit: vector code
    good &= static_cast<unsigned>(values[i] >= low) & static_cast<unsigned>(values[i] <= high);
  }
  return good != 0;
}

}  // namespace

extern const AllWithin all_within;
const AllWithin all_within = within;

}  // namespace vam::io::exr::VAM_SIMD

// SPDX-License-Identifier: GPL-3.0-or-later
// No file that these tools write or accept holds NaN or infinity.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace vam::io {

/// All exponent bits set is NaN or infinity (IEEE 754). On the bits, without an early exit, this is vector code that
/// runs at memory speed.
[[nodiscard]] inline bool all_finite(const float* values, std::size_t count) {
  constexpr std::uint32_t exponent = 0x7f800000U;
  std::uint32_t bad = 0;
  for (std::size_t i = 0; i < count; ++i) {
    bad |= static_cast<std::uint32_t>((std::bit_cast<std::uint32_t>(values[i]) & exponent) == exponent);
  }
  return bad == 0;
}

}  // namespace vam::io

// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers that look random, the same on every machine.
#pragma once

#include <cstdint>

namespace vam {

/// The next state of a sequence, and a number that is far from its neighbours' (splitmix64).
[[nodiscard]] constexpr std::uint64_t scrambled(std::uint64_t n) {
  n += 0x9E3779B97F4A7C15U;
  n = (n ^ (n >> 30U)) * 0xBF58476D1CE4E5B9U;
  n = (n ^ (n >> 27U)) * 0x94D049BB133111EBU;
  return n ^ (n >> 31U);
}

/// Its upper 53 bits as a number in [0, 1).
[[nodiscard]] constexpr double unit_interval(std::uint64_t n) { return static_cast<double>(n >> 11U) * 0x1p-53; }

}  // namespace vam

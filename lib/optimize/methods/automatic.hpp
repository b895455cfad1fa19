// SPDX-License-Identifier: GPL-3.0-or-later
// The method of --method auto: the one with the best results in tests/bench/printability, run until the part
// prints with a margin, and for a minimum number of iterations, so that easy parts also obtain a wide process window.
#pragma once

namespace vam::optimize {

inline constexpr const char* automatic_method = "apg";
inline constexpr const char* automatic_until = "ver=0,pw>=0.06";
inline constexpr int automatic_iterations = 12;
inline constexpr int automatic_refinements = 8;  // of projections that were made at half of the resolution
inline constexpr int early_refinements = 5;      // where the print's surface is true by then

}  // namespace vam::optimize

// What --method auto stands for: the method that measures best in tests/bench/printability, until the part prints with
// room to spare, and a few iterations at least: what prints from the start has a wider window than simpler methods
// give.
#pragma once

namespace vam::optimize {

inline constexpr const char* automatic_method = "apg";
inline constexpr const char* automatic_until = "ver=0,pw>=0.06";
inline constexpr int automatic_iterations = 12;
inline constexpr int automatic_refinements = 8;  // of projections that were made at half of the resolution
inline constexpr int early_refinements = 5;      // where the print's surface is true by then

}  // namespace vam::optimize

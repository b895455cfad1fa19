// SPDX-License-Identifier: GPL-3.0-or-later
// The method of --method auto: the one with the best results in tests/bench/printability, run until the part
// prints with a margin, and on to the knee of latitude against cost, so that easy parts also obtain a wide latitude.
#pragma once

namespace vam::optimize {

inline constexpr const char* automatic_method = "apg";
inline constexpr const char* automatic_until = "ver=0,latitude>=0.06";
inline constexpr const char* shortest_until = "ver=0,latitude>=0.08";
inline constexpr double automatic_rate = 0.8;  // a quarter more cost must widen the latitude by 20 %
inline constexpr int automatic_iterations = 16;

}  // namespace vam::optimize

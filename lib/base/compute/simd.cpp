// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/compute/simd.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace vam {

namespace {

Simd detect() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
  if (avx2 && avx512) return Simd::avx512;
  if (avx2) return Simd::avx2;
#endif
  return Simd::baseline;
}

Simd ceiling() {
  const char* wish = std::getenv("VAM_SIMD");
  if (wish != nullptr && std::string_view(wish) == "baseline") return Simd::baseline;
  if (wish != nullptr && std::string_view(wish) == "avx2") return Simd::avx2;
  return Simd::avx512;
}

}  // namespace

Simd simd_level() {
  static const Simd level = std::min(detect(), ceiling());
  return level;
}

}  // namespace vam

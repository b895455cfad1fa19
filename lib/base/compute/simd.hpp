// SPDX-License-Identifier: GPL-3.0-or-later
// Run-time choice of instruction set. A kernel file lib/<module>/<name>_kernel.cc is compiled once per level with
// VAM_SIMD set to baseline, avx2 or avx512 and puts its functions in namespace VAM_SIMD; the module's ordinary source
// picks one by VAM_KERNEL. Kernel files include no standard headers with inline code: a function compiled for
// AVX-512 must never be the one the linker keeps for everybody.
#pragma once

namespace vam {

enum class Simd { baseline, avx2, avx512 };

/// The best level this processor has, or a lower one when $VAM_SIMD names it (baseline, avx2, avx512).
[[nodiscard]] Simd simd_level();

}  // namespace vam

/// What namespace baseline, avx2 or avx512 holds under that name: a kernel, or a table of kernels, compiled for
/// `level`.
#if defined(__x86_64__)
#define VAM_KERNEL(name, level) \
  ((level) == ::vam::Simd::avx512 ? avx512::name : (level) == ::vam::Simd::avx2 ? avx2::name : baseline::name)
#else
#define VAM_KERNEL(name, level) (static_cast<void>(level), baseline::name)
#endif

// SPDX-License-Identifier: GPL-3.0-or-later
// One vector register of floats at the instruction set a kernel file is compiled for. For *_kernel.cc only.
#pragma once

namespace vam::VAM_SIMD {

#if defined(__AVX512F__)
constexpr int vector_floats = 16;
#elif defined(__AVX2__)
constexpr int vector_floats = 8;
#else
constexpr int vector_floats = 4;
#endif

using Vector = float __attribute__((vector_size(vector_floats * 4), may_alias, aligned(4)));

/// The constraint of assembler text that keeps a value in a vector register.
#if defined(__aarch64__)
#define VAM_PINNED "+w"
#else
#define VAM_PINNED "+x"
#endif

inline Vector load(const float* from) { return *reinterpret_cast<const Vector*>(from); }
inline void store(float* to, Vector value) { *reinterpret_cast<Vector*>(to) = value; }

}  // namespace vam::VAM_SIMD

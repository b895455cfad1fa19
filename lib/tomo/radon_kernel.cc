// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once per instruction set (base/compute/simd.hpp). A call builds a table of weights for two outputs and eight
// rows in one vector, then applies it to up to four slabs: no branch, no gather, no index arithmetic in the inner loop.
#include "tomo/private/radon_kernel.hpp"

#include "base/compute/kernel_vector.hpp"

namespace vam::tomo::VAM_SIMD {

namespace {

constexpr int width = vam::VAM_SIMD::vector_floats;
using Vector = float __attribute__((vector_size(width * 4), may_alias));

using Bits = int __attribute__((vector_size(width * 4), may_alias));

inline Vector load(const float* from) { return *reinterpret_cast<const Vector*>(from); }
inline void store(float* to, Vector value) { *reinterpret_cast<Vector*>(to) = value; }

inline float least(float a, float b) { return a < b ? a : b; }
inline float most(float a, float b) { return a > b ? a : b; }

struct Table {
  alignas(64) float weight[4][pair_entries];
  alignas(64) int offset[pair_entries];
  alignas(64) int base[pair_entries];
};

/// Weights of `taps` neighbouring elements: differences of the trapezoid's area up to their common edges. The last
/// edge lies beyond the footprint, so its value is the total: the weights add up to it.
template <int taps, int slabs>
inline void tabulate(const Gather& job, float pair, Table& table) {
  const Footprints& f = *job.footprints;
  const float last = job.last;
  float zero = 0;
  asm("" : VAM_PINNED(zero));  // a maximum with a known zero becomes a comparison and a masked move, twice the work
  for (int e = 0; e < pair_entries; ++e) {
    const float start = job.first[e] + pair * f.step[e];
    const int base = static_cast<int>(least(most(start, zero), last));
    const float edge = static_cast<float>(base) - start + f.first_edge[e];
    const Trapezoid shadow{f.half[e], f.flat[e], f.slope[e], f.curve[e]};
    float below = -f.half_total[e];
    for (int k = 0; k + 1 < taps; ++k) {
      const float up_to = shadow.area_up_to(edge + static_cast<float>(k));
      table.weight[k][e] = up_to - below;
      below = up_to;
    }
    table.weight[taps - 1][e] = f.half_total[e] - below;
    table.base[e] = base;
    table.offset[e] = job.row_offset[e] + base * (slabs * lanes);
  }
}

/// Multiplies the weights by e^{alpha u} of their pixels; u is separable in x and y, so two factors do.
template <int taps, Attenuation attenuation>
inline void attenuate(const Gather& job, int output, Table& table) {
  for (int e = 0; e < pair_entries; ++e) {
    for (int k = 0; k < taps; ++k) {
      const float factor =
          attenuation == by_output ? job.factor[output * gather_rows + e] : job.factor[table.base[e] + k];
      table.weight[k][e] *= job.row_factor[e] * factor;
    }
  }
}

/// Both outputs of the pair, `registers` vectors of lanes at once, beginning at lane `lane`.
template <int taps, int slabs, int registers>
inline void apply(const Gather& job, const Table& table, int output, bool odd, int lane) {
  Vector even_sum[registers] = {};
  Vector odd_sum[registers] = {};
  const float* input = job.input + lane;
#pragma GCC unroll 8
  for (int r = 0; r < gather_rows; ++r) {
    const float* even_from = input + table.offset[r];
    const float* odd_from = input + table.offset[gather_rows + r];
#pragma GCC unroll 4
    for (int k = 0; k < taps; ++k) {
      const float even_weight = table.weight[k][r];
      const float odd_weight = table.weight[k][gather_rows + r];
#pragma GCC unroll 4
      for (int v = 0; v < registers; ++v) {
        even_sum[v] += even_weight * load(even_from + k * slabs * lanes + v * width);
        odd_sum[v] += odd_weight * load(odd_from + k * slabs * lanes + v * width);
      }
    }
  }
  // Without this the compiler puts the odd sums off until after the even ones are stored, and spills their operands.
#pragma GCC unroll 4
  for (int v = 0; v < registers; ++v) {
    asm volatile("" : VAM_PINNED(even_sum[v]), VAM_PINNED(odd_sum[v]));
  }
#pragma GCC unroll 4
  for (int v = 0; v < registers; ++v) {
    const int at = lane + v * width;
    float* to = job.output[at / lanes] + output * job.output_step + at % lanes;
    store(to, load(to) + even_sum[v]);
    if (odd) store(to + job.output_step, load(to + job.output_step) + odd_sum[v]);
  }
}

template <int taps, int slabs, Attenuation attenuation>
void gather(const Gather& job) {
  constexpr int vectors = slabs * lanes / width;
  constexpr int registers = vectors < 4 ? vectors : 4;
  Table table;
  for (int output = 0; output < job.outputs; output += 2) {
    tabulate<taps, slabs>(job, static_cast<float>(output), table);
    if constexpr (attenuation != plain) attenuate<taps, attenuation>(job, output, table);
    asm volatile("" : : "r"(&table) : "memory");  // weights are broadcast from memory, not kept and permuted
    for (int v = 0; v < vectors; v += registers) {
      apply<taps, slabs, registers>(job, table, output, output + 1 < job.outputs, v * width);
    }
  }
}

bool interleave(const Interleave& job) {
  Bits seen{};
  for (int s = 0; s < job.slabs; ++s) {
    const float* from = job.from[s];
    const float* plus = job.plus[s];
    float* to = job.to + s * lanes;
    for (int i = 0; i < job.count; ++i) {
      for (int v = 0; v < lanes; v += width) {
        Vector value = load(from + v);
        if (plus != nullptr) value += load(plus + v);
        seen |= reinterpret_cast<Bits&>(value);
        store(to + v, value);
      }
      from += job.from_step;
      if (plus != nullptr) plus += job.plus_step;
      to += job.slabs * lanes;
    }
  }
  bool any = false;
  for (int v = 0; v < width; ++v) any = any || (seen[v] & 0x7fffffff) != 0;
  return any;
}

}  // namespace

const RadonKernels radon_kernels = {{{{gather<3, 1, plain>, gather<3, 1, by_output>, gather<3, 1, by_element>},
                                      {gather<4, 1, plain>, gather<4, 1, by_output>, gather<4, 1, by_element>}},
                                     {{gather<3, 2, plain>, gather<3, 2, by_output>, gather<3, 2, by_element>},
                                      {gather<4, 2, plain>, gather<4, 2, by_output>, gather<4, 2, by_element>}},
                                     {{gather<3, 4, plain>, gather<3, 4, by_output>, gather<3, 4, by_element>},
                                      {gather<4, 4, plain>, gather<4, 4, by_output>, gather<4, 4, by_element>}}},
                                    interleave};

}  // namespace vam::tomo::VAM_SIMD

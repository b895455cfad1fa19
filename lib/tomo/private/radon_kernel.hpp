// SPDX-License-Identifier: GPL-3.0-or-later
// The one inner loop of both directions: every output gathers from eight input rows through trapezoid footprints.
// Adjoint: output = pixel, row = angle, element = detector bin. Forward: output = bin, row = pixel row, element =
// pixel. Plain structs and pointers only: this header is compiled once per instruction set.
#pragma once

#include <cstddef>

#include "base/compute/slab_lanes.hpp"
#include "tomo/footprint.hpp"

namespace vam::tomo {

inline constexpr int gather_rows = 8;  // input rows reduced by one call
inline constexpr std::size_t kernel_rows = gather_rows;
inline constexpr int pair_entries = 2 * gather_rows;  // two outputs at once: one vector of 16 table entries
inline constexpr int group_slabs = 4;                 // slabs that share one table of weights
inline constexpr int group_lanes = group_slabs * lanes;

/// Trapezoids of area `total` in units of one element, and how they move: entries 0..7 belong to the even output of a
/// pair and rows 0..7, entries 8..15 to the odd output. half, flat, slope and curve are those of tomo::Trapezoid.
struct Footprints {
  alignas(64) float step[pair_entries];  // advance of the centre per output
  alignas(64) float half[pair_entries];
  alignas(64) float flat[pair_entries];
  alignas(64) float curve[pair_entries];
  alignas(64) float slope[pair_entries];
  alignas(64) float half_total[pair_entries];  // total / 2
  alignas(64) float first_edge[pair_entries];  // 1 - half: from `start` (below) to the first inner edge, less the base
};

/// output[o] += sum over rows r and taps k of weight(o, r, k) * input[row_offset[r] + (base(o, r) + k) * L].
struct Gather {
  alignas(64) float first[pair_entries];       // centre for the first pair of outputs, in elements from the row's start
  alignas(64) int row_offset[pair_entries];    // start of the row in `input`, in floats
  alignas(64) float row_factor[pair_entries];  // attenuated only: e^{alpha u}, the part that depends on the row
  const Footprints* footprints;
  const float* input;
  float last;  // highest base element; rows are padded by zeros, so that bases are clamped to [0, last]
  int outputs;
  float* output[group_slabs];
  long output_step;     // floats between outputs
  const float* factor;  // attenuated only: per element (forward) or per output and row (adjoint)
};

/// Copies `count` elements of 16 lanes from each of `slabs` streams side by side, adding a second set when given.
struct Interleave {
  const float* from[group_slabs];
  const float* plus[group_slabs];  // or null
  long from_step;                  // floats between elements
  long plus_step;
  int slabs;
  int count;
  float* to;
};

enum Attenuation { plain, by_output, by_element };

struct RadonKernels {
  void (*gather[3][2][3])(const Gather&);  // [log2(slabs)][taps - 3][Attenuation]
  bool (*interleave)(const Interleave&);   // was any value not zero?
};

namespace baseline {
extern const RadonKernels radon_kernels;
}
namespace avx2 {
extern const RadonKernels radon_kernels;
}
namespace avx512 {
extern const RadonKernels radon_kernels;
}

}  // namespace vam::tomo

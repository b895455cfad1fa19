// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled once per instruction set (base/compute/simd.hpp). Across the pixels of a row there is no branch: where a
// column is in its part is already in the two offsets.
#include "resin/curethrough/private/correction_kernel.hpp"

namespace vam::resin::VAM_SIMD {

namespace {

inline double target(const CorrectionRow& row, int i) {
  const double from_below = row.table[row.below[i] - row.node];
  const double from_above = row.table[row.above[i] + row.node];
  return __builtin_fabs(from_below < from_above ? from_below : from_above);
}

inline double clamped(double phi, const CorrectionRow& row) {  // against rounding: the target is within the limits
  const double raised = phi > row.phi_min ? phi : row.phi_min;
  return raised < row.phi_max ? raised : row.phi_max;
}

void forward(const CorrectionRow& row) {
  const double per_gain = 1 / row.gain;
  const double per_max = 1 / row.phi_max;
  for (int i = 0; i < row.count; ++i) {
    const double next = target(row, i);
    const double phi = (row.omega[i] - row.q * next) * per_gain;  // [CURE19 eq 5] solved for Phi
    row.out[i] = static_cast<float>(clamped(phi, row) * per_max);
    row.omega[i] = next;
  }
}

void wanted(const CorrectionRow& row) {
  const double per_gain = 1 / row.gain;
  for (int i = 0; i < row.count; ++i) {
    row.out[i] = static_cast<float>((target(row, i) - row.q * row.omega[i]) * per_gain);
  }
}

bool any_equal(const int* values, int value, int count) {
  int found = 0;
  for (int i = 0; i < count; ++i) found |= values[i] == value;
  return found != 0;
}

}  // namespace

extern const CorrectionKernels correction_kernels;
const CorrectionKernels correction_kernels{forward, wanted, any_equal};

}  // namespace vam::resin::VAM_SIMD

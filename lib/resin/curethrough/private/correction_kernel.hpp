// SPDX-License-Identifier: GPL-3.0-or-later
// One row of one slice of the correction. Plain structs and pointers only: compiled once per instruction set.
#pragma once

namespace vam::resin {

struct CorrectionRow {
  const double* table;  // TargetDose::table()
  const int* below;     // per pixel, TargetDose offsets
  const int* above;
  double* omega;  // per pixel: the dose at the node already passed
  float* out;     // per pixel
  int count;
  int node;  // the node to look up
  double q;
  double gain;
  double phi_min;
  double phi_max;
};

struct CorrectionKernels {
  /// From the platform on: omega holds the target at node - 1; out = Phi of that slice / phi_max; omega becomes the
  /// target at `node`.
  void (*forward)(const CorrectionRow&);
  /// From the window on: omega holds the dose reached at node + 1; out = the Phi of slice `node` that would reach the
  /// target. omega stays.
  void (*wanted)(const CorrectionRow&);
  /// Is any of the values equal to `value`?
  bool (*any_equal)(const int* values, int value, int count);
};

namespace baseline {
extern const CorrectionKernels correction_kernels;
}
namespace avx2 {
extern const CorrectionKernels correction_kernels;
}
namespace avx512 {
extern const CorrectionKernels correction_kernels;
}

}  // namespace vam::resin

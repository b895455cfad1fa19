// SPDX-License-Identifier: GPL-3.0-or-later
// Values at points along a line through a grid of transforms, and the transpose. A cell of the grid holds one complex
// value, or 8 side by side: two slices each. Plain structs and pointers only: compiled once per instruction set.
#pragma once

namespace vam::tomo {

inline constexpr int grid_taps = 6;    // of the kernel, along each axis
inline constexpr int taps_before = 2;  // of them before the grid point at or below the position
inline constexpr int tap_powers = 7;   // coefficients of a tap's polynomial: it errs by 1e-5 of the kernel
inline constexpr int grid_margin = 4;  // cells on every side that repeat those of the other: taps, and one for rounding

/// Tap t is a polynomial of z = 2 (position - grid point below) - 1, the highest power first.
struct TapPolynomials {
  alignas(64) float tap[tap_powers][16];  // 0..5 at 0..5 and at 8..13: along x and along y
};

/// Points x + i * step_x, y + i * step_y, i < count, in cells from the grid's first, margins included.
struct GridLine {
  const TapPolynomials* taps;
  float* grid;
  long row_step;  // floats from one row of cells to the next
  double x;
  double y;
  double step_x;
  double step_y;
  int count;
  bool conjugate;  // of cells of one value: the line's are the conjugates
  float* line;     // a cell a point
};

/// Cells at even distances, and each of their complex values in a row of its own.
struct CellRows {
  float* cells;
  long cell_step;  // floats
  float* rows;
  long row_step;  // floats
  int count;
};

/// Two halves of a line that alias onto the same frequencies, and the complex factor of each cell.
struct AliasPair {
  float* low;
  float* high;
  const float* low_factor;
  const float* high_factor;
  int count;
};

/// [0]: one complex value a cell, [1]: 8.
struct FourierKernels {
  void (*interpolate[2])(const GridLine&);  // line = values of the grid
  void (*spread[2])(const GridLine&);       // grid += its transpose of the line
  void (*part[2])(const CellRows&);         // rows = cells
  void (*join[2])(const CellRows&);         // cells = rows
  void (*fold)(const AliasPair&);           // cells of 8: high = factor * high + factor * low
  void (*unfold)(const AliasPair&);         // both = conj(factor) * high
};

namespace baseline {
extern const FourierKernels fourier_kernels;
}
namespace avx2 {
extern const FourierKernels fourier_kernels;
}
namespace avx512 {
extern const FourierKernels fourier_kernels;
}

}  // namespace vam::tomo

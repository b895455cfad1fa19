// SPDX-License-Identifier: GPL-3.0-or-later
// What the Fourier operator knows of a geometry before it sees an image.
#pragma once

#include <complex>
#include <vector>

#include "tomo/private/radon_plan.hpp"

namespace vam::tomo {

/// Points on the line of one angle whose base cells lie in one tile of the grid: j = first .. first + count - 1, at
/// sign times j times the step of the angle, moved by whole turns of the periodic grid.
struct LineRun {
  int angle;
  int first;
  int count;
  int sign;  // -1: at the opposite points, where the transform of a real image is the conjugate
  double shift_x;
  double shift_y;
};

/// Grid, lines and factors. A complex value of a cell is that of a pair of slices. Of a single slice, which is real,
/// half of the grid and of each line is kept: x and j from 0 on.
struct FourierPlan {
  Plan turn;     // the angles to work out
  int columns;   // of the detector
  int width;     // pixels along x
  int height;    // along y
  int centre_x;  // the pixel of phase 0
  int centre_y;
  int grid_x;  // points of the periodic grid
  int grid_y;
  int length;                   // of the 1-D transforms: all projections fit, shadows beyond the detector, too
  bool real;                    // a single slice
  std::vector<float> weight_x;  // deapodisation
  std::vector<float> weight_y;
  int tiles_x;
  int tiles_y;
  std::vector<std::vector<LineRun>> tiles;   // [y * tiles_x + x], by angle and j
  std::vector<std::complex<float>> factors;  // [angle][j - first_j]: of the transform at j / length cycles per pixel

  /// Points of a line: |j| < length, up to one cycle per pixel, where the bin's own transform has its zero. What a
  /// sinogram's low frequencies alias to lies just below it.
  [[nodiscard]] int points() const { return real ? length : 2 * length; }
  [[nodiscard]] int first_j() const { return real ? 0 : -length; }
  /// With the taps' margins 90 kB of cells of 8 values, 40 kB of those of one: a tile stays in L2.
  [[nodiscard]] int tile_cells() const { return real ? 64 : 32; }
  /// Columns of the grid that are kept.
  [[nodiscard]] int kept_x() const { return real ? grid_x / 2 + 1 : grid_x; }
  [[nodiscard]] int rays() const { return static_cast<int>(turn.rays.size()); }
  [[nodiscard]] double step_x(int angle) const { return turn.rays[angle].cosine * grid_x / length; }
  [[nodiscard]] double step_y(int angle) const { return turn.rays[angle].sine * grid_y / length; }
};

[[nodiscard]] FourierPlan make_fourier_plan(const ParallelGeometry& geometry, bool one_slice);

}  // namespace vam::tomo

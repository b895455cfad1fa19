// SPDX-License-Identifier: GPL-3.0-or-later
// The transform of 16 slices, or of one, on the points of a zero-padded grid, and its values along lines.
#pragma once

#include <array>
#include <vector>

#include "base/compute/slab.hpp"
#include "tomo/private/fft.hpp"
#include "tomo/private/fourier_kernel.hpp"
#include "tomo/private/fourier_plan.hpp"

namespace vam::tomo {

/// Values of a complex cell side by side: rows of pixels, of the grid, of a line.
class FourierGrid {
 public:
  FourierGrid(const FourierPlan& plan, const FourierKernels& kernels);

  /// grid = transform of the image, which is divided by the kernel's transform before; and its transpose.
  void transform(const Slab& image);
  void transform_back(Slab& image);
  /// lines[angle][j - first_j] = value of the grid at j steps of the angle; and its transpose.
  void interpolate(float* lines);
  void spread(float* lines);

  [[nodiscard]] int values() const { return values_; }
  [[nodiscard]] std::ptrdiff_t cell() const { return cell_; }                // floats
  [[nodiscard]] std::size_t kernel() const { return values_ == 1 ? 0 : 1; }  // its place in FourierKernels

 private:
  void load(const Slab& image, int y, float* rows, int pitch) const;
  void store(Slab& image, int y, float* rows, int pitch) const;
  void transform_rows(float* rows, int pitch, bool forward) const;
  [[nodiscard]] int row_of_pixels(int y) const;
  void columns(bool forward);
  void column(int x, bool forward);
  void fill_margins();
  void fold_margins();
  template <class Work>
  void for_margin_columns(const Work& work) const;
  template <class Work>
  void for_margin_rows(const Work& work) const;
  [[nodiscard]] GridLine line_of(const LineRun& run, float* lines);
  [[nodiscard]] float* at(int x, int y) { return grid_.data() + y * row_step_ + x * cell_; }

  const FourierPlan& plan_;
  const FourierKernels& kernels_;
  int values_;  // complex ones in a cell
  std::ptrdiff_t cell_;
  std::ptrdiff_t row_step_;  // floats
  Fft fft_x_;
  RealFft real_fft_x_;
  Fft fft_y_;
  std::array<std::vector<int>, 4> colours_;  // tiles of which no two write to the same cell
  Buffer grid_;
};

/// Of rows of complex values, in cache lines: what FFTW's plans are made for.
[[nodiscard]] inline int pitch_of(int length) { return (length + 7) / 8 * 8; }

}  // namespace vam::tomo

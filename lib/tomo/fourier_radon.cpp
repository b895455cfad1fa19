// SPDX-License-Identifier: GPL-3.0-or-later
// From the lines of the grid to projections and back: factors, aliases, one transform an angle and pair of slices.
#include "tomo/fourier_radon.hpp"

#include <algorithm>
#include <mutex>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "tomo/private/fourier_grid.hpp"

namespace vam::tomo {

namespace {

using Complex = std::complex<float>;

Complex* complex(float* values) { return reinterpret_cast<Complex*>(values); }

}  // namespace

struct FourierRadon::State {
  ParallelGeometry geometry;
  FourierPlan plan;
  const FourierKernels& kernels;
  FourierGrid grid;
  Fft fft;
  RealFft real_fft;
  Buffer lines;  // [angle][j - first_j][values]
  std::mutex busy;

  State(const ParallelGeometry& of, Slices slices, Simd level)
      : geometry(of),
        plan(make_fourier_plan(of, slices == Slices::one)),
        kernels(VAM_KERNEL(fourier_kernels, level)),
        grid(plan, kernels),
        fft(plan.length),
        real_fft(plan.length),
        lines(product(product(plan.rays(), plan.points()), grid.cell())) {}

  [[nodiscard]] int pitch() const { return pitch_of(plan.length); }
  [[nodiscard]] float* rows(std::size_t which) const { return scratch(which, product(grid.cell(), pitch() + 8)); }
  [[nodiscard]] float* line(int angle) {
    return lines.data() + product(angle, plan.points()) * static_cast<std::size_t>(grid.cell());
  }
  [[nodiscard]] const float* factors(int angle) const {
    return reinterpret_cast<const float*>(&plan.factors[product(angle, plan.points())]);
  }
  void to_rows(int angle, float* rows);
  void to_line(int angle, float* rows);
  void to_real_row(int angle, float* row);
  void to_real_line(int angle, float* row);
  void put(const float* rows, int row, bool mirrored, Slab& sinogram) const;
  void take(const Slab& sinogram, int row, bool mirrored, float* rows) const;
  void project(int angle, Slab& sinogram);
  void light(int angle, const Slab& sinogram);
};

/// Pairs of slices: the two halves of a line alias, then are transformed to projections.
void FourierRadon::State::to_rows(int angle, float* rows) {
  const long half = plan.length * grid.cell();
  kernels.fold({line(angle), line(angle) + half, factors(angle), factors(angle) + 2L * plan.length, plan.length});
  kernels.part[1]({line(angle) + half, lanes, rows, 2L * pitch(), plan.length});
  Complex* row = complex(rows);
  for (int v = 0; v < grid.values(); ++v, row += pitch()) fft.backward(row);
}

void FourierRadon::State::to_line(int angle, float* rows) {
  Complex* row = complex(rows);
  for (int v = 0; v < grid.values(); ++v, row += pitch()) fft.forward(row);
  const long half = plan.length * grid.cell();
  kernels.join[1]({line(angle) + half, lanes, rows, 2L * pitch(), plan.length});
  kernels.unfold({line(angle), line(angle) + half, factors(angle), factors(angle) + 2L * plan.length, plan.length});
}

/// A single slice: what j and j - length hold is the same frequency, and j - length is the conjugate of length - j.
void FourierRadon::State::to_real_row(int angle, float* row) {
  const Complex* value = complex(line(angle));
  const Complex* factor = &plan.factors[product(angle, plan.points())];
  const auto real = [&](int j) { return factor[j].real() * value[j].real() - factor[j].imag() * value[j].imag(); };
  const auto imaginary = [&](int j) { return factor[j].real() * value[j].imag() + factor[j].imag() * value[j].real(); };
  Complex* to = complex(row);
  to[0] = real(0);
  for (int j = 1; j <= plan.length / 2; ++j) {
    const int other = plan.length - j;
    to[j] = {real(j) + real(other), imaginary(j) - imaginary(other)};
  }
  real_fft.backward(row);
}

/// The transpose; j stands for -j, too, but 0.
void FourierRadon::State::to_real_line(int angle, float* row) {
  real_fft.forward(row);
  const Complex* value = complex(row);
  const Complex* factor = &plan.factors[product(angle, plan.points())];
  Complex* to = complex(line(angle));
  for (int j = 0; j < plan.length; ++j) {
    const bool upper = 2 * j > plan.length;
    const Complex& here = value[upper ? plan.length - j : j];
    const float real = j == 0 ? 0.5F * here.real() : here.real();
    const float imaginary = upper ? -here.imag() : here.imag();
    to[j] = {factor[j].real() * real + factor[j].imag() * imaginary,
             factor[j].real() * imaginary - factor[j].imag() * real};
  }
}

void FourierRadon::State::put(const float* rows, int row, bool mirrored, Slab& sinogram) const {
  float* to = sinogram.at(mirrored ? plan.columns - 1 : 0, row);
  const int step = mirrored ? -lanes : lanes;
  if (!plan.real) return kernels.join[1]({to, step, const_cast<float*>(rows), 2L * pitch(), plan.columns});
  for (int c = 0; c < plan.columns; ++c, to += step) {
    std::fill_n(to, lanes, 0.0F);
    *to = rows[c];
  }
}

/// rows = the sinogram's row, zeros beyond the detector.
void FourierRadon::State::take(const Slab& sinogram, int row, bool mirrored, float* rows) const {
  std::fill_n(rows, grid.cell() * pitch(), 0.0F);
  const float* from = sinogram.at(mirrored ? plan.columns - 1 : 0, row);
  const int step = mirrored ? -lanes : lanes;
  if (!plan.real) return kernels.part[1]({const_cast<float*>(from), step, rows, 2L * pitch(), plan.columns});
  for (int c = 0; c < plan.columns; ++c, from += step) rows[c] = *from;
}

/// One projection, and its mirror image half a turn later.
void FourierRadon::State::project(int angle, Slab& sinogram) {
  float* work = rows(0);
  plan.real ? to_real_row(angle, work) : to_rows(angle, work);
  put(work, angle, false, sinogram);
  if (plan.turn.folded) put(work, angle + plan.rays(), true, sinogram);
}

/// The transpose.
void FourierRadon::State::light(int angle, const Slab& sinogram) {
  float* work = rows(0);
  take(sinogram, angle, false, work);
  if (plan.turn.folded) {
    float* other = rows(1);
    take(sinogram, angle + plan.rays(), true, other);
    for (std::size_t i = 0; i < product(grid.cell(), pitch()); ++i) work[i] += other[i];
  }
  plan.real ? to_real_line(angle, work) : to_line(angle, work);
}

FourierRadon::FourierRadon(const ParallelGeometry& geometry, Slices slices, Simd level)
    : state_(std::make_unique<State>(geometry, slices, level)) {}

FourierRadon::~FourierRadon() = default;

void FourierRadon::forward(std::span<const Slab> images, std::span<Slab> sinograms) const {
  check_shapes(state_->geometry, images, sinograms);
  const std::lock_guard<std::mutex> lock(state_->busy);
  for (std::size_t s = 0; s < images.size(); ++s) {
    state_->grid.transform(images[s]);
    state_->grid.interpolate(state_->lines.data());
    parallel_for(state_->plan.rays(), [&](int angle) { state_->project(angle, sinograms[s]); });
  }
}

void FourierRadon::adjoint(std::span<const Slab> sinograms, std::span<Slab> images) const {
  check_shapes(state_->geometry, images, sinograms);
  const std::lock_guard<std::mutex> lock(state_->busy);
  for (std::size_t s = 0; s < images.size(); ++s) {
    parallel_for(state_->plan.rays(), [&](int angle) { state_->light(angle, sinograms[s]); });
    state_->grid.spread(state_->lines.data());
    state_->grid.transform_back(images[s]);
  }
}

}  // namespace vam::tomo

// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/parallel_operator.hpp"

#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "light/operators/private/one_slice_operator.hpp"

namespace vam::light {

namespace {

bool may_halve(const tomo::ParallelGeometry& turn) { return turn.angles % 2 == 0 && turn.alpha_per_px == 0; }

tomo::ParallelGeometry first_half(tomo::ParallelGeometry turn) {
  if (may_halve(turn)) turn.angles /= 2;
  return turn;
}

double row_angle(const tomo::ParallelGeometry& turn) {
  return std::abs(turn.angle_step_rad) * (may_halve(turn) ? 2 : 1);
}

}  // namespace

ParallelOperator::ParallelOperator(const tomo::ParallelGeometry& turn, LineIntegrals integrals)
    : turn_(turn),
      rows_(first_half(turn)),
      row_angle_rad_(row_angle(turn)),
      inverse_(turn.columns, turn.angle_step_rad, 0.5 * row_angle_rad_) {
  using Slices = tomo::FourierRadon::Slices;
  if (integrals == LineIntegrals::footprints) return;
  const Slices slices = integrals == LineIntegrals::fourier_of_one ? Slices::one : Slices::all;
  fourier_ = std::make_unique<tomo::FourierRadon>(rows_, slices);
}

void ParallelOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  fourier_ ? fourier_->forward(objects, sinograms) : tomo::forward(rows_, objects, sinograms);
}

void ParallelOperator::adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const {
  fourier_ ? fourier_->adjoint(sinograms, objects) : tomo::adjoint(rows_, sinograms, objects);
}

std::unique_ptr<Operator> ParallelOperator::for_one_slice() const {
  return OneSliceOperator::is_for(turn_) ? std::make_unique<OneSliceOperator>(turn_) : nullptr;
}

void ParallelOperator::expand(const Slab& sinogram, Slab& image) const {
  const auto fluence = static_cast<float>(1.0 / row_angle_rad_);
  parallel_for(turn_.angles, [&](int a) {
    const bool mirrored = a >= rows_.angles;
    for (int c = 0; c < turn_.columns; ++c) {
      const float* from = mirrored ? sinogram.at(turn_.columns - 1 - c, a - rows_.angles) : sinogram.at(c, a);
      std::transform(from, from + lanes, image.at(c, a), [&](float v) { return v * fluence; });
    }
  });
}

void ParallelOperator::collapse(const Slab& image, Slab& sinogram) const {
  const auto dose = static_cast<float>(halved() ? 0.5 * row_angle_rad_ : row_angle_rad_);
  parallel_for(rows_.angles, [&](int a) {
    for (int c = 0; c < turn_.columns; ++c) {
      const float* here = image.at(c, a);
      const float* there = halved() ? image.at(turn_.columns - 1 - c, a + rows_.angles) : nullptr;
      float* to = sinogram.at(c, a);
      for (int lane = 0; lane < lanes; ++lane) to[lane] = dose * (here[lane] + (there ? there[lane] : 0.0F));
    }
  });
}

}  // namespace vam::light

#include "light/parallel.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/per_slice.hpp"
#include "light/preconditioner.hpp"

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

ParallelOperator::ParallelOperator(const tomo::ParallelGeometry& turn)
    : turn_(turn),
      rows_(first_half(turn)),
      row_angle_rad_(row_angle(turn)),
      ramp_(turn.columns, {}),
      preconditioner_(turn.columns, preconditioner_spec(turn)) {}

/// Filtered back-projection over a full turn is f = (1/2) integral of ramp * p over theta [KS88 eq 36]; a row's value
/// is its fluence times the angle it stands for.
void ParallelOperator::apply(const tomo::Filter& filter, std::span<Slab> sinograms) const {
  const auto gain = static_cast<float>(0.5 * row_angle_rad_);
  for (Slab& slab : sinograms) filter.apply(slab);
  for_values(sinograms, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) sinograms[s].values[i] *= gain;
  });
}

void ParallelOperator::filter(std::span<Slab> sinograms) const { apply(ramp_, sinograms); }

void ParallelOperator::precondition(std::span<Slab> sinograms) const { apply(preconditioner_, sinograms); }

void ParallelOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  tomo::forward(rows_, objects, sinograms);
}

void ParallelOperator::adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const {
  tomo::adjoint(rows_, sinograms, objects);
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

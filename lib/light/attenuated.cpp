#include "light/attenuated.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/per_slice.hpp"
#include "base/text.hpp"
#include "light/preconditioner.hpp"
#include "model/circle.hpp"

namespace vam::light {

namespace {

tomo::ParallelGeometry with_alpha(tomo::ParallelGeometry geometry, double alpha_per_px) {
  geometry.alpha_per_px = alpha_per_px;
  return geometry;
}

}  // namespace

void require_translucent(double mu_per_px, double resin_radius_px) {
  constexpr double deepest = 40;  // e^40 squared is a float
  const double depth = mu_per_px * resin_radius_px;
  if (depth <= deepest) return;
  throw Error{Fault::data, "resin.absorption_per_mm: the intensity falls to e^-" + format_number(depth, 3) +
                               " of its value on the way to the axis, and e^-" + format_number(deepest) +
                               " can be computed with; absorption is per mm and to base e (ln 10 times absorbance)"};
}

AttenuatedOperator::AttenuatedOperator(const tomo::ParallelGeometry& turn, double mu_per_px, double resin_radius_px,
                                       Correction correction)
    : dose_(with_alpha(turn, -mu_per_px)),
      radius_(resin_radius_px),
      correction_(correction),
      ramp_(turn.columns, {}),
      preconditioner_(turn.columns, preconditioner_spec(turn)),
      exponential_(turn.columns, {.alpha_per_px = mu_per_px}) {
  require_translucent(mu_per_px, resin_radius_px);
  for (int c = 0; c < turn.columns; ++c) {
    const double t = c - 0.5 * (turn.columns - 1);
    const double depth = model::half_chord(radius_, t);
    transmitted_.push_back(static_cast<float>(std::exp(-mu_per_px * depth)));
    amplified_.push_back(static_cast<float>(std::exp(mu_per_px * depth)));
  }
}

void AttenuatedOperator::scale_columns(std::span<Slab> sinograms, const std::vector<float>& factor, double gain) const {
  for_values(sinograms, [&](std::size_t s, std::size_t first, std::size_t last) {
    float* row = sinograms[s].values.data() + first;
    for (std::size_t i = 0; i < last - first; ++i) row[i] *= factor[i / lanes] * static_cast<float>(gain);
  });
}

void AttenuatedOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  tomo::forward(dose_, objects, sinograms);
  scale_columns(sinograms, transmitted_);
}

void AttenuatedOperator::adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const {
  std::vector<Slab> dimmed(sinograms.begin(), sinograms.end());
  scale_columns(dimmed, transmitted_);
  tomo::adjoint(dose_, dimmed, objects);
}

/// A = W A_mu, so (A A*)^-1 is about W^-1 ramp W^-1.
void AttenuatedOperator::apply(const tomo::Filter& filter, std::span<Slab> sinograms) const {
  scale_columns(sinograms, amplified_);
  for (Slab& slab : sinograms) filter.apply(slab);
  scale_columns(sinograms, amplified_, 0.5 * row_angle_rad());
}

void AttenuatedOperator::filter(std::span<Slab> sinograms) const { apply(ramp_, sinograms); }

void AttenuatedOperator::precondition(std::span<Slab> sinograms) const { apply(preconditioner_, sinograms); }

/// g = e^{mu sqrt(R^2 - t^2)} * (ramp on |k| >= mu) * T_mu f [TM80, CAL19 eq 2; physics §5]: weight e^{+mu u} on the
/// way in.
void AttenuatedOperator::invert(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  if (correction_ == Correction::exact) {
    tomo::forward(with_alpha(dose_, -dose_.alpha_per_px), objects, sinograms);
    for (Slab& slab : sinograms) exponential_.apply(slab);
    scale_columns(sinograms, amplified_, 0.5 * row_angle_rad());
    return;
  }
  std::vector<Slab> corrected(objects.begin(), objects.end());
  divide_by_disc_dose(corrected);
  tomo::forward(with_alpha(dose_, 0), corrected, sinograms);
  for (Slab& slab : sinograms) {
    ramp_.apply(slab);
    for (float& v : slab.values) v *= static_cast<float>(0.5 * row_angle_rad());
  }
}

/// The projections of a uniform disc are made as if nothing were absorbed; what they give with absorption, relative to
/// the disc, is divided out of the objects [OST22 Methods; physics §5].
void AttenuatedOperator::divide_by_disc_dose(std::span<Slab> objects) const {
  std::vector<Slab> disc = slabs(1, dose_.nx, dose_.ny);
  const model::Circle circle{dose_.axis_x, dose_.axis_y, std::min(radius_, 0.5 * dose_.columns - 1)};
  for (int y = 0; y < dose_.ny; ++y) {
    for (int x = 0; x < dose_.nx; ++x) std::fill_n(disc[0].at(x, y), lanes, circle.contains(x, y) ? 1.0F : 0.0F);
  }
  std::vector<Slab> light = slabs(1, dose_.columns, dose_.angles);
  tomo::forward(with_alpha(dose_, 0), disc, light);
  ramp_.apply(light[0]);
  clip_below(light, 0.0F);
  std::vector<Slab> dose = slabs(1, dose_.nx, dose_.ny);
  adjoint(light, dose);
  float largest = 0;
  for (const float d : dose[0].values) largest = std::max(largest, d);
  constexpr float least = 0.01F;  // of the largest dose: outside the disc there is none to divide by
  for_values(objects, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      objects[s].values[i] /= std::max(dose[0].values[i] / largest, least);
    }
  });
}

void AttenuatedOperator::expand(const Slab& sinogram, Slab& image) const {
  image = sinogram;
  for (float& v : image.values) v *= static_cast<float>(1.0 / row_angle_rad());
}

void AttenuatedOperator::collapse(const Slab& image, Slab& sinogram) const {
  sinogram = image;
  for (float& v : sinogram.values) v *= static_cast<float>(row_angle_rad());
}

}  // namespace vam::light

#include "light/shadowed.hpp"

#include <algorithm>
#include <cmath>

#include "base/per_slice.hpp"
#include "light/attenuated.hpp"
#include "light/preconditioner.hpp"
#include "model/circle.hpp"

namespace vam::light {

namespace {

/// Integral from -infinity to x of a voxel's shadow: the trapezoid box(|cos|) * box(|sin|) of area 1.
double shadow_up_to(double x, double cosine, double sine) {
  const double wide = std::max(std::abs(cosine), std::abs(sine));
  const double narrow = std::min(std::abs(cosine), std::abs(sine));
  const double outer = 0.5 * (wide + narrow);
  const double inner = 0.5 * (wide - narrow);
  if (x <= -outer) return 0;
  if (x >= outer) return 1;
  if (x < -inner) return (x + outer) * (x + outer) / (2 * wide * narrow);
  if (x > inner) return 1 - (outer - x) * (outer - x) / (2 * wide * narrow);
  return 0.5 + x / wide;
}

}  // namespace

ShadowedOperator::ShadowedOperator(const tomo::ParallelGeometry& turn, double mu_per_px, double resin_radius_px,
                                   std::span<const Slab> inserts)
    : turn_(turn), mu_(mu_per_px), ramp_(turn.columns, {}), preconditioner_(turn.columns, preconditioner_spec(turn)) {
  require_translucent(mu_per_px, resin_radius_px);
  for (int c = 0; c < turn.columns; ++c) {
    const double t = c - 0.5 * (turn.columns - 1);
    depth_.push_back(model::half_chord(resin_radius_px, t));
  }
  for (int a = 0; a < turn.angles; ++a) {
    cosine_.push_back(std::cos(turn.angle_start_rad + a * turn.angle_step_rad));
    sine_.push_back(std::sin(turn.angle_start_rad + a * turn.angle_step_rad));
  }
  std::vector<double> angles;
  for (int a = 0; a < turn.angles; ++a) angles.push_back(turn.angle_start_rad + a * turn.angle_step_rad);
  const model::Grid grid{turn.nx, turn.ny, 0, 1, {-turn.axis_x, -turn.axis_y, 0}};  // in voxels
  const auto ray = [&](int column, int row) -> PixelRay {
    return {true, column - 0.5 * (turn.columns - 1), 0, static_cast<double>(row), 0};
  };
  shadow_ = InsertShadow(grid, inserts, angles, turn.columns, static_cast<int>(inserts.size()), ray);
}

ShadowedOperator::Footprint ShadowedOperator::footprint(int x, int y, int angle) const {
  const double c = cosine_[angle];
  const double s = sine_[angle];
  const double dx = x - turn_.axis_x;
  const double dy = y - turn_.axis_y;
  const double column = dx * c + dy * s + 0.5 * (turn_.columns - 1);
  Footprint print{};
  print.u = -dx * s + dy * c;
  print.first = static_cast<int>(std::floor(column - 0.5 * (std::abs(c) + std::abs(s)) + 0.5));
  double before = 0;
  for (int i = 0; i < 4; ++i) {
    const double up_to = shadow_up_to(print.first + i + 0.5 - column, c, s);
    const bool seen = print.first + i >= 0 && print.first + i < turn_.columns;
    print.weight[i] = seen ? static_cast<float>(up_to - before) : 0.0F;
    before = up_to;
  }
  return print;
}

float ShadowedOperator::left(int column, double u) const {
  return static_cast<float>(std::exp(-mu_ * (depth_[column] + u)));
}

void ShadowedOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  parallel_for(static_cast<int>(objects.size()) * turn_.angles, [&](int item) {
    const auto s = static_cast<std::size_t>(item / turn_.angles);
    const int a = item % turn_.angles;
    std::fill_n(sinograms[s].at(0, a), static_cast<std::size_t>(turn_.columns) * lanes, 0.0F);
    for (int y = 0; y < turn_.ny; ++y) {
      for (int x = 0; x < turn_.nx; ++x) {
        const Footprint print = footprint(x, y, a);
        const auto u = static_cast<float>(print.u);
        const float* from = objects[s].at(x, y);
        for (int i = 0; i < 4; ++i) {
          if (print.weight[i] <= 0) continue;
          const float weight = print.weight[i] * left(print.first + i, print.u);
          const float* ends = shadow_.ends()[s].at(print.first + i, a);
          float* to = sinograms[s].at(print.first + i, a);
          for (int lane = 0; lane < lanes; ++lane) to[lane] += u < ends[lane] ? weight * from[lane] : 0.0F;
        }
      }
    }
  });
}

void ShadowedOperator::adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const {
  parallel_for(static_cast<int>(objects.size()) * turn_.ny, [&](int item) {
    const auto s = static_cast<std::size_t>(item / turn_.ny);
    const int y = item % turn_.ny;
    for (int x = 0; x < turn_.nx; ++x) {
      float sum[lanes] = {};
      for (int a = 0; a < turn_.angles; ++a) {
        const Footprint print = footprint(x, y, a);
        const auto u = static_cast<float>(print.u);
        for (int i = 0; i < 4; ++i) {
          if (print.weight[i] <= 0) continue;
          const float weight = print.weight[i] * left(print.first + i, print.u);
          const float* ends = shadow_.ends()[s].at(print.first + i, a);
          const float* from = sinograms[s].at(print.first + i, a);
          for (int lane = 0; lane < lanes; ++lane) sum[lane] += u < ends[lane] ? weight * from[lane] : 0.0F;
        }
      }
      std::copy_n(sum, lanes, objects[s].at(x, y));
    }
  });
}

/// As without shadows (AttenuatedOperator): W^-1 ramp W^-1, W what is left of the light at the plane of the axis.
void ShadowedOperator::apply(const tomo::Filter& filter, std::span<Slab> sinograms) const {
  const auto amplify = [&](double gain) {
    for_values(sinograms, [&](std::size_t s, std::size_t first, std::size_t last) {
      float* row = sinograms[s].values.data() + first;
      for (std::size_t i = 0; i < last - first; ++i)
        row[i] *= static_cast<float>(gain / static_cast<double>(left(static_cast<int>(i / lanes), 0)));
    });
  };
  amplify(1);
  for (Slab& slab : sinograms) filter.apply(slab);
  amplify(0.5 * row_angle_rad());
}

void ShadowedOperator::filter(std::span<Slab> sinograms) const { apply(ramp_, sinograms); }

void ShadowedOperator::precondition(std::span<Slab> sinograms) const { apply(preconditioner_, sinograms); }

void ShadowedOperator::expand(const Slab& sinogram, Slab& image) const {
  image = sinogram;
  for (float& v : image.values) v *= static_cast<float>(1.0 / row_angle_rad());
}

void ShadowedOperator::collapse(const Slab& image, Slab& sinogram) const {
  sinogram = image;
  for (float& v : sinogram.values) v *= static_cast<float>(row_angle_rad());
}

}  // namespace vam::light

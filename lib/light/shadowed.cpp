#include "light/private/shadowed.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "model/circle.hpp"
#include "tomo/absorption.hpp"

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
    : turn_(turn),
      mu_(mu_per_px),
      inverse_(turn.columns, turn.angle_step_rad, 0.5 * row_angle_rad(),
               tomo::to_the_axis(turn.columns, mu_per_px, resin_radius_px)) {
  tomo::require_translucent(mu_per_px, resin_radius_px);
  const auto offset = [&](int column) { return column - 0.5 * (turn_.columns - 1); };
  for (int c = 0; c < turn.columns; ++c) depth_.push_back(model::half_chord(resin_radius_px, offset(c)));
  std::vector<double> angles;
  for (int a = 0; a < turn.angles; ++a) {
    angles.push_back(turn.angle_start_rad + a * turn.angle_step_rad);
    directions_.push_back({std::cos(angles.back()), std::sin(angles.back())});
  }
  const model::Grid grid{turn.nx, turn.ny, 0, 1, {-turn.axis_x, -turn.axis_y, 0}};  // in voxels
  const auto ray = [&](int column, int row) -> PixelRay {
    return {true, offset(column), 0, static_cast<double>(row), 0};
  };
  shadow_ = InsertShadow(grid, inserts, angles, turn.columns, static_cast<int>(inserts.size()), ray);
}

ShadowedOperator::Footprint ShadowedOperator::footprint(int x, int y, int angle) const {
  const auto [c, s] = directions_[angle];
  const double dx = x - turn_.axis_x;
  const double dy = y - turn_.axis_y;
  const double column = dx * c + dy * s + 0.5 * (turn_.columns - 1);
  Footprint result{};
  result.u = -dx * s + dy * c;
  result.first = static_cast<int>(std::floor(column - 0.5 * (std::abs(c) + std::abs(s)) + 0.5));
  double before = 0;
  for (int i = 0; i < most_columns; ++i) {
    const double up_to = shadow_up_to(result.first + i + 0.5 - column, c, s);
    const bool seen = result.first + i >= 0 && result.first + i < turn_.columns;
    result.weight[i] = seen ? static_cast<float>(up_to - before) : 0.0F;
    before = up_to;
  }
  return result;
}

template <class Visit>
void ShadowedOperator::each_column(const Footprint& footprint, std::size_t slab, int angle, const Visit& visit) const {
  for (int i = 0; i < most_columns; ++i) {
    if (footprint.weight[i] <= 0) continue;
    const int column = footprint.first + i;
    const auto transmitted = static_cast<float>(std::exp(-mu_ * (depth_[column] + footprint.u)));
    visit(column, footprint.weight[i] * transmitted, shadow_.ends()[slab].at(column, angle));
  }
}

void ShadowedOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  parallel_for(static_cast<int>(objects.size()) * turn_.angles, [&](int item) {
    const auto s = static_cast<std::size_t>(item / turn_.angles);
    const int a = item % turn_.angles;
    std::fill_n(sinograms[s].at(0, a), static_cast<std::size_t>(turn_.columns) * lanes, 0.0F);
    for (int y = 0; y < turn_.ny; ++y) {
      for (int x = 0; x < turn_.nx; ++x) {
        const Footprint voxel = footprint(x, y, a);
        const auto u = static_cast<float>(voxel.u);
        const float* from = objects[s].at(x, y);
        each_column(voxel, s, a, [&](int column, float weight, const float* ends) {
          float* to = sinograms[s].at(column, a);
          for (int lane = 0; lane < lanes; ++lane) to[lane] += u < ends[lane] ? weight * from[lane] : 0.0F;
        });
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
        const Footprint voxel = footprint(x, y, a);
        const auto u = static_cast<float>(voxel.u);
        each_column(voxel, s, a, [&](int column, float weight, const float* ends) {
          const float* from = sinograms[s].at(column, a);
          for (int lane = 0; lane < lanes; ++lane) sum[lane] += u < ends[lane] ? weight * from[lane] : 0.0F;
        });
      }
      std::copy_n(sum, lanes, objects[s].at(x, y));
    }
  });
}

}  // namespace vam::light

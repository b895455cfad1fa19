// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/shadowed_operator.hpp"

#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "model/absorption.hpp"
#include "model/circle.hpp"
#include "tomo/axis_transmission.hpp"
#include "tomo/footprint.hpp"

namespace vam::light {

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
  const auto ray = [&](int column, int row, int) -> PixelRay {
    return {true, offset(column), 0, static_cast<double>(row), 0};
  };
  shadow_ = InsertShadow(grid, inserts, angles, turn.columns, count_of(inserts), true, ray);
}

ShadowedOperator::Footprint ShadowedOperator::footprint(int x, int y, int angle) const {
  const auto [c, s] = directions_[angle];
  const double dx = x - turn_.axis_x;
  const double dy = y - turn_.axis_y;
  const double column = dx * c + dy * s + 0.5 * (turn_.columns - 1);
  const auto wide = static_cast<float>(std::max(std::abs(c), std::abs(s)));
  const auto narrow = static_cast<float>(std::min(std::abs(c), std::abs(s)));
  const auto shadow = tomo::Trapezoid::of(wide, narrow, 1);
  Footprint result{};
  result.u = -dx * s + dy * c;
  result.first = floor_int(column - shadow.half + 0.5);
  float before = -0.5F;
  for (int i = 0; i < most_columns; ++i) {
    const float up_to = shadow.area_up_to(static_cast<float>(result.first + i + 0.5 - column));
    const bool seen = result.first + i >= 0 && result.first + i < turn_.columns;
    result.weight[i] = seen ? up_to - before : 0.0F;
    before = up_to;
  }
  return result;
}

template <class Visit>
void ShadowedOperator::each_column(const Footprint& footprint, std::size_t slab, int angle, const Visit& visit) const {
  for (int i = 0; i < most_columns; ++i) {
    if (footprint.weight[i] <= 0) continue;
    const int column = footprint.first + i;
    const auto transmitted = static_cast<float>(model::transmitted(mu_, depth_[column] + footprint.u));
    visit(column, footprint.weight[i] * transmitted, shadow_.ends()[slab].at(column, angle));
  }
}

void ShadowedOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  parallel_for(count_of(objects) * turn_.angles, [&](int item) {
    const auto s = static_cast<std::size_t>(item / turn_.angles);
    const int a = item % turn_.angles;
    std::fill_n(sinograms[s].at(0, a), product(turn_.columns, lanes), 0.0F);
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
  parallel_for(count_of(objects) * turn_.ny, [&](int item) {
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

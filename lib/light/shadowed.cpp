#include "light/shadowed.hpp"

#include <algorithm>
#include <cmath>

#include "base/per_slice.hpp"
#include "light/preconditioner.hpp"

namespace vam::light {

namespace {

constexpr float opaque = 0.5F;    // coverage
constexpr float far_away = 1e9F;  // no insert in the way

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
  for (int c = 0; c < turn.columns; ++c) {
    const double t = c - 0.5 * (turn.columns - 1);
    depth_.push_back(std::sqrt(std::max(0.0, resin_radius_px * resin_radius_px - t * t)));
  }
  for (int a = 0; a < turn.angles; ++a) {
    cosine_.push_back(std::cos(turn.angle_start_rad + a * turn.angle_step_rad));
    sine_.push_back(std::sin(turn.angle_start_rad + a * turn.angle_step_rad));
  }
  for (const Slab& insert : inserts) {
    reach_.emplace_back(turn.columns, turn.angles);
    cast_shadows(insert, reach_.back());
  }
}

ShadowedOperator::Footprint ShadowedOperator::footprint(int x, int y, int angle) const {
  const double c = cosine_[static_cast<std::size_t>(angle)];
  const double s = sine_[static_cast<std::size_t>(angle)];
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
  return static_cast<float>(std::exp(-mu_ * (depth_[static_cast<std::size_t>(column)] + u)));
}

/// Every column that sees part of an opaque voxel ends at the voxel's near side.
void ShadowedOperator::cast_shadows(const Slab& insert, Slab& reach) const {
  std::fill(reach.values.begin(), reach.values.end(), far_away);
  parallel_for(turn_.angles, [&](int a) {
    const double half =
        0.5 * (std::abs(cosine_[static_cast<std::size_t>(a)]) + std::abs(sine_[static_cast<std::size_t>(a)]));
    for (int y = 0; y < turn_.ny; ++y) {
      for (int x = 0; x < turn_.nx; ++x) {
        const float* coverage = insert.at(x, y);
        if (std::none_of(coverage, coverage + lanes, [](float v) { return v >= opaque; })) continue;
        const Footprint print = footprint(x, y, a);
        for (int i = 0; i < 4; ++i) {
          if (print.weight[i] <= 0) continue;
          float* ends = reach.at(print.first + i, a);
          for (int lane = 0; lane < lanes; ++lane) {
            if (coverage[lane] >= opaque) ends[lane] = std::min(ends[lane], static_cast<float>(print.u - half));
          }
        }
      }
    }
  });
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
          const float* ends = reach_[s].at(print.first + i, a);
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
          const float* ends = reach_[s].at(print.first + i, a);
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
  amplify(0.5 * turn_.angle_step_rad);
}

void ShadowedOperator::filter(std::span<Slab> sinograms) const { apply(ramp_, sinograms); }

void ShadowedOperator::precondition(std::span<Slab> sinograms) const { apply(preconditioner_, sinograms); }

void ShadowedOperator::expand(const Slab& sinogram, Slab& image) const {
  image = sinogram;
  for (float& v : image.values) v *= static_cast<float>(1.0 / turn_.angle_step_rad);
}

void ShadowedOperator::collapse(const Slab& image, Slab& sinogram) const {
  sinogram = image;
  for (float& v : sinogram.values) v *= static_cast<float>(turn_.angle_step_rad);
}

}  // namespace vam::light

#include "light/vial_shadows.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

namespace vam::light {

namespace {

constexpr float opaque = 0.5F;    // coverage
constexpr float far_away = 1e9F;  // no insert in the way

}  // namespace

VialShadows::VialShadows(const VialRays& rays, std::span<const Slab> inserts)
    : grid_(rays.setup().grid), stride_(rays.row_stride()) {
  if (inserts.empty()) return;
  const VialSetup& setup = rays.setup();
  for (int a = 0; a < setup.turn.rows; ++a) {
    const double theta = setup.direction * (setup.turn.start_rad + a * setup.turn.step_rad) + setup.angle_offset_rad;
    rows_.push_back({std::cos(theta), std::sin(theta)});
  }
  for (int c = 0; c < stride_; ++c) {
    const int column = rays.first_column() + std::clamp(c - VialRays::padding, 0, rays.columns() - 1);
    const optics::ChiefRay ray = optics::chief_ray(setup.view, setup.projector.x_mm(column));
    columns_.push_back({std::cos(ray.delta_rad), std::sin(ray.delta_rad)});
    half_.push_back(0.5 * grid_.voxel_mm / (ray.jacobian * setup.projector.pixel_mm));
  }
  for (const Slab& insert : inserts) {
    reach_.emplace_back(stride_, setup.turn.rows);
    cast(rays, insert, reach_.back());
  }
}

/// u of L(t, theta + delta) [physics section 1]: how far along the ray of that column the voxel lies, in mm.
float VialShadows::depth(int i, int j, int row, int column) const {
  const Direction& part = rows_[static_cast<std::size_t>(row)];
  const Direction& ray = columns_[static_cast<std::size_t>(column)];
  const double x = grid_.x_mm(i) * part.cosine + grid_.y_mm(j) * part.sine;  // in the lab
  const double y = grid_.y_mm(j) * part.cosine - grid_.x_mm(i) * part.sine;
  return static_cast<float>(y * ray.cosine - x * ray.sine);
}

VialShadows::Sight VialShadows::sight(const VialTaps& taps, int r, int row) const {
  const int cell = taps.cell[r] - r * stride_;
  const float light = taps.left[r] + taps.right[r];
  const double place = cell + (light > 0 ? static_cast<double>(taps.right[r] / light) : 0.0);
  const Direction& part = rows_[static_cast<std::size_t>(row)];
  const Direction& ray = columns_[static_cast<std::size_t>(cell)];
  const double c = part.cosine * ray.cosine - part.sine * ray.sine;  // of theta + delta
  const double s = part.sine * ray.cosine + part.cosine * ray.sine;
  const double extent = std::abs(c) + std::abs(s);  // of a voxel, across and along the ray
  const double half = half_[static_cast<std::size_t>(cell)] * extent;
  return {std::max(static_cast<int>(std::ceil(place - half)), 0),
          std::min(static_cast<int>(std::floor(place + half)), stride_ - 1),
          static_cast<float>(0.5 * extent * grid_.voxel_mm)};
}

/// Every column that sees part of an opaque voxel ends at the voxel's near side.
void VialShadows::cast(const VialRays& rays, const Slab& insert, Slab& reach) const {
  std::fill(reach.values.begin(), reach.values.end(), far_away);
  const int blocks = (reach.height + vial_rows - 1) / vial_rows;
  parallel_for(blocks, [&](int block) {
    const int first = block * vial_rows;
    const int rows = std::min(vial_rows, reach.height - first);
    VialRays::Voxel voxel{};
    VialTaps taps;
    for (int j = 0; j < grid_.ny; ++j) {
      for (int i = 0; i < grid_.nx; ++i) {
        const float* coverage = insert.at(i, j);
        if (std::none_of(coverage, coverage + lanes, [](float v) { return v >= opaque; })) continue;
        if (!rays.find(i, j, voxel)) continue;
        rays.taps(voxel, first, rows, taps);
        for (int r = 0; r < rows; ++r) {
          const int row = first + r;
          const Sight seen = sight(taps, r, row);
          for (int column = seen.first; column <= seen.last; ++column) {
            float* ends = reach.at(column, row);
            const float u = depth(i, j, row, column) - seen.near_mm;
            for (int lane = 0; lane < lanes; ++lane) {
              if (coverage[lane] >= opaque) ends[lane] = std::min(ends[lane], u);
            }
          }
        }
      }
    }
  });
}

template <class Visit>
void VialShadows::each_ray(const Slab& reach, int i, int j, int row, int rows, const VialTaps& taps,
                           const Visit& visit) const {
  for (int r = 0; r < rows; ++r) {
    for (const int side : {0, 1}) {
      const int column = taps.cell[r] - r * stride_ + side;
      const float weight = side == 0 ? taps.left[r] : taps.right[r];
      const float u = depth(i, j, row + r, column);
      const float* ends = reach.at(column, row + r);
      const auto at = static_cast<std::ptrdiff_t>(taps.cell[r] + side) * lanes;
      for (int lane = 0; lane < lanes; ++lane) visit(at, lane, u < ends[lane] ? weight : 0.0F);
    }
  }
}

void VialShadows::gather(std::size_t slab, int i, int j, int row, int rows, const VialTaps& taps, const float* light,
                         float* voxel) const {
  each_ray(reach_[slab], i, j, row, rows, taps,
           [&](std::ptrdiff_t at, int lane, float weight) { voxel[lane] += weight * light[at + lane]; });
}

void VialShadows::scatter(std::size_t slab, int i, int j, int row, int rows, const VialTaps& taps, const float* voxel,
                          float* light) const {
  each_ray(reach_[slab], i, j, row, rows, taps,
           [&](std::ptrdiff_t at, int lane, float weight) { light[at + lane] += weight * voxel[lane]; });
}

}  // namespace vam::light

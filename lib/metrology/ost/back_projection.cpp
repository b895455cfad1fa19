// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/back_projection.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "base/compute/parallel.hpp"
#include "base/compute/simd.hpp"
#include "base/index.hpp"
#include "metrology/ost/private/climb_kernel.hpp"

namespace vam::metrology {

namespace {

using Index = std::ptrdiff_t;

// Rays climb alike within a tile: u departs from that of its middle by 5.6 voxels at most, and what this does to a
// voxel's height averages out over the angles. Tiles of a block share the detector columns in cache.
constexpr int tile = climb_tile;
constexpr int tiles_across = 4;
constexpr int block = tile * tiles_across;
constexpr int tiles_a_block = tiles_across * tiles_across;
constexpr int tile_columns = tile * tile;
constexpr int angles_together = 4;
constexpr double most_climb = 0.06;  // of a height from the axis to the rim, so that vectors of 16 can follow
constexpr int widest = 14;           // detector columns that a tile sees: 7 sqrt(2) + 3

struct ClimbKernels {
  decltype(&baseline::climb_columns) climb;
  decltype(&baseline::place_tile) place;
  decltype(&baseline::add_tile) add;
};

ClimbKernels kernels() {
  const Simd level = simd_level();
  return {VAM_KERNEL(climb_columns, level), VAM_KERNEL(place_tile, level), VAM_KERNEL(add_tile, level)};
}

// Detector values about a stretch of heights as [angle][column][height]; 0 where there are none.
class DetectorStretch {
 public:
  DetectorStretch(const ClimbingRays& rays, const std::vector<Slab>& filtered, int first, int heights)
      : columns_(rays.columns), length_((heights + 2 * spare + lanes - 1) / lanes * lanes) {
    values_.resize(start(rays.angles, -beside));
    parallel_for(rays.angles, [&](int a) {
      const int begin = std::max(first - spare, 0);
      const int end = std::min(first - spare + length_, count_of(filtered) * lanes);
      for (int t = 0; t < columns_; ++t) {
        float* to = values_.data() + start(a, t) - (first - spare);
        for (int k = begin; k < end;) {
          const int part = std::min(end - k, lanes - k % lanes);
          std::copy_n(filtered[k / lanes].at(t, a) + k % lanes, part, to + k);
          k += part;
        }
      }
    });
  }
  /// Height `first` of a column, or of one of a few beside the detector.
  [[nodiscard]] const float* at(int angle, int column) const {
    return values_.data() + start(angle, std::clamp(column, -beside, columns_)) + spare;
  }
  [[nodiscard]] Index stride() const { return length_; }

 private:
  static constexpr int spare = 3;
  static constexpr int beside = widest;
  [[nodiscard]] Index start(int angle, int column) const {
    return (Index{angle} * (columns_ + 2 * beside) + column + beside) * length_;
  }
  int columns_;
  int length_;
  std::vector<float, CacheAligned<float>> values_;
};

struct Scratch {
  std::vector<float, CacheAligned<float>> shifted, sums;
  std::array<int, std::size_t{angles_together} * tile_columns> base{};
  std::array<float, std::size_t{angles_together} * tile_columns> low{}, high{};
  std::array<float, tile_columns> gain{};
};

// Is all of a square of voxels outside the circle that the detector sees?
bool is_outside(const ClimbingRays& rays, const model::Grid& grid, int x0, int y0, int edge) {
  const double near_x_mm = std::clamp(0.0, grid.x_mm(x0), grid.x_mm(x0 + edge - 1));
  const double near_y_mm = std::clamp(0.0, grid.y_mm(y0), grid.y_mm(y0 + edge - 1));
  return std::hypot(near_x_mm, near_y_mm) > 0.5 * rays.columns * grid.voxel_mm;
}

class BackProjection {
 public:
  /// The detector begins at slice `first`.
  BackProjection(const ClimbingRays& rays, const DetectorStretch& detector, int first, const model::Grid& grid)
      : rays_(rays), detector_(detector), first_(first), grid_(grid), kernels_(kernels()) {
    for (int a = 0; a < rays.angles; ++a) {
      const double theta = 2 * std::numbers::pi * a / rays.angles;
      directions_.push_back({std::cos(theta), std::sin(theta)});
    }
  }

  // Sums of a block of voxel columns from (x0, y0) on, tile after tile, `heights` from `slice` on.
  void sum(int x0, int y0, int slice, int heights, Scratch& scratch) const {
    scratch.shifted.resize(std::size_t{angles_together} * widest * climb_heights);
    scratch.sums.assign(std::size_t{tiles_a_block} * tile_columns * climb_heights, 0.0F);
    for (int a = 0; a < rays_.angles; a += angles_together) {
      const int angles = std::min(angles_together, rays_.angles - a);
      for (int n = 0; n < tiles_a_block; ++n) {
        const int x = x0 + n % tiles_across * tile;
        const int y = y0 + n / tiles_across * tile;
        if (is_outside(rays_, grid_, x, y, tile)) continue;
        for (int m = 0; m < angles; ++m) prepare(a + m, m, x, y, slice, heights, scratch);
        kernels_.add({scratch.shifted.data(), Index{widest} * climb_heights, angles, tile_columns, scratch.base.data(),
                      scratch.low.data(), scratch.high.data(), heights,
                      scratch.sums.data() + Index{n} * tile_columns * climb_heights});
      }
    }
  }

 private:
  // The detector columns of one angle at the heights of the tile's middle, and each voxel column's place among them.
  void prepare(int angle, int m, int x0, int y0, int slice, int heights, Scratch& scratch) const {
    const auto [c, s] = directions_[angle];
    const double x = grid_.x_mm(x0) / grid_.voxel_mm;
    const double y = grid_.y_mm(y0) / grid_.voxel_mm;
    constexpr double reach = tile - 1;
    const double t_first = x * c + y * s + 0.5 * (rays_.columns - 1);
    const int left = floor_int(t_first + std::min(0.0, c * reach) + std::min(0.0, s * reach));
    const int seen = std::min(widest, 3 + static_cast<int>((std::abs(c) + std::abs(s)) * reach));
    const double u_mm = (-(x + 0.5 * reach) * s + (y + 0.5 * reach) * c) * grid_.voxel_mm;
    const double zero = -grid_.origin_mm[2] / grid_.voxel_mm;  // slice of height 0
    const int column = std::clamp(left + seen / 2, 0, rays_.columns - 1);
    const double part = std::clamp(rays_.rate_per_mm[column] * u_mm, -most_climb, most_climb);
    const double slope = 1 / (1 + part);
    kernels_.climb({detector_.at(angle, left), detector_.stride(), seen, zero + (slice - zero) * slope - first_, slope,
                    heights, scratch.shifted.data() + Index{m} * widest * climb_heights});
    if (rays_.gain_per_mm == 0) {
      scratch.gain.fill(static_cast<float>(rays_.scale));
    } else {
      const double rate = rays_.gain_per_mm * grid_.voxel_mm;
      for (int q = 0; q < tile_columns; ++q) {
        const int right = q % tile;
        const int up = q / tile;
        scratch.gain[q] = static_cast<float>(rays_.scale * std::exp(rate * (-(x + right) * s + (y + up) * c)));
      }
    }
    const auto entry = product(m, tile_columns);
    kernels_.place({static_cast<float>(t_first - left), static_cast<float>(c), static_cast<float>(s),
                    static_cast<float>(seen) - 2, scratch.gain.data(), scratch.base.data() + entry,
                    scratch.low.data() + entry, scratch.high.data() + entry});
  }

  const ClimbingRays& rays_;
  const DetectorStretch& detector_;
  int first_;
  const model::Grid& grid_;
  ClimbKernels kernels_;
  std::vector<std::array<double, 2>> directions_;
};

// Puts a block of sums into the volume, within the circle that the detector sees.
void put(const Scratch& scratch, int x0, int y0, int slice, int count, int columns, model::Volume& volume) {
  const model::Grid& g = volume.grid;
  const double radius_mm = 0.5 * columns * g.voxel_mm;
  for (int j = y0; j < std::min(y0 + block, g.ny); ++j) {
    const double half_mm = std::sqrt(std::max(0.0, (radius_mm - g.y_mm(j)) * (radius_mm + g.y_mm(j))));
    for (int x = x0; x < std::min(x0 + block, g.nx); x += tile) {
      const int first = std::max(x, ceil_int((-half_mm - g.origin_mm[0]) / g.voxel_mm));
      const int last = std::min({x + tile - 1, g.nx - 1, floor_int((half_mm - g.origin_mm[0]) / g.voxel_mm)});
      if (first > last) continue;
      const int n = (j - y0) / tile * tiles_across + (x - x0) / tile;
      const float* from =
          scratch.sums.data() + (Index{n} * tile_columns + Index{(j - y0) % tile} * tile + first - x) * climb_heights;
      for (int k = 0; k < count; k += lanes) {
        const int some = std::min(lanes, count - k);
        std::array<float*, lanes> out{};
        for (int s = 0; s < some; ++s) out[s] = volume.slice(slice + k + s) + Index{j} * g.nx + first;
        one_by_one(from + k, climb_heights, last - first + 1, std::span(out).first(some));
      }
    }
  }
}

}  // namespace

int heights_beyond(const ClimbingRays& rays, const model::Grid& grid) {
  double steepest = 0;
  for (const double rate : rays.rate_per_mm) steepest = std::max(steepest, std::abs(rate));
  const double radius_mm = 0.5 * rays.columns * grid.voxel_mm;
  const double farthest = std::max(std::abs(grid.z_mm(0)), std::abs(grid.z_mm(grid.nz - 1))) / grid.voxel_mm;
  const double part = std::min(most_climb, steepest * radius_mm);
  return 2 + ceil_int(farthest * part / (1 - part));
}

void back_project(const ClimbingRays& rays, const std::vector<Slab>& filtered, int beyond, int first, int count,
                  model::Volume& volume) {
  const model::Grid& g = volume.grid;
  const int across = (g.nx + block - 1) / block;
  const int down = (g.ny + block - 1) / block;
  for (int from = 0; from < count; from += climb_heights) {
    const int slices = std::min(climb_heights, count - from);
    const int heights = (slices + climb_step - 1) / climb_step * climb_step;
    const DetectorStretch detector(rays, filtered, from, heights + 2 * beyond);
    const BackProjection job(rays, detector, first + from - beyond, g);
    parallel_for(across * down, [&](int item) {
      thread_local Scratch scratch;
      const int x0 = item % across * block;
      const int y0 = item / across * block;
      if (is_outside(rays, g, x0, y0, block)) return;
      job.sum(x0, y0, first + from, heights, scratch);
      put(scratch, x0, y0, first + from, slices, rays.columns, volume);
    });
  }
}

}  // namespace vam::metrology

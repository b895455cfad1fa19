// SPDX-License-Identifier: GPL-3.0-or-later
// What the design's surface asks of the dose: to be the threshold at points of the surface, and in voxels that it cuts
// on the side of the threshold that prints them as part or void [physics §6].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/compute/per_slice.hpp"
#include "optimize/methods/method.hpp"
#include "optimize/target/problem.hpp"

namespace vam::optimize {

/// A point between the centres of two neighbouring voxels, one of at least half coverage and one of less:
/// dose = (1 - share) dose[from] + share dose[to].
struct SurfacePoint {
  struct Voxel {
    std::uint32_t slab, i;
  };
  Voxel from, to;
  float share;   // 0...1
  float weight;  // the lesser one of the two voxels
  float cosine;  // between the outward normal and the way from `from` to `to`
};

/// A voxel that the surface cuts: part if it is at least half covered, else void.
struct CutVoxel {
  SurfacePoint::Voxel at;
  float weight;
  bool is_part;
};

/// The points of a problem, each along the axis that is nearest to the surface's normal there, or, as at the foot of a
/// thin wall, along another one where the surface does not pass beside a voxel along that axis; between two slices only
/// where they are stacked; and its cut voxels. None where the surface is free, or a voxel, or one beside the point, is
/// outside or has weight 0.
class SurfacePoints {
 public:
  SurfacePoints() = default;
  explicit SurfacePoints(const Problem& problem);

  /// Dose - threshold at every point, then by how much the dose of every cut voxel is beyond the threshold.
  [[nodiscard]] std::vector<float> misses(std::span<const Slab> dose) const;
  /// Sum of (1/2) (w/2) miss^2, by the slice of the cut voxel, or that the point begins in.
  [[nodiscard]] PerSlice losses(std::span<const float> misses, std::size_t slabs) const;
  /// Adds `share` of the derivatives of these losses by the doses: the transpose of misses().
  void add_slopes(std::span<const float> misses, std::span<Slab> slopes, float share = 1) const;
  /// Errors of the dose, linear between the two voxels; points are weighted by the area that they represent.
  [[nodiscard]] SurfaceMiss miss(std::span<const Slab> dose) const;
  [[nodiscard]] const std::vector<SurfacePoint>& points() const { return points_; }

 private:
  std::vector<SurfacePoint> points_;
  std::vector<CutVoxel> cut_;
  float threshold_ = 0;
};

}  // namespace vam::optimize

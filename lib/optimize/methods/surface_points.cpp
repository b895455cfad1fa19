// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/methods/private/surface_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/index.hpp"

namespace vam::optimize {

namespace {

constexpr float half = 0.5F;

/// Coverage by voxel, in the order of the slices: a volume where they are stacked, else slices that have no neighbours.
class TargetVolume {
 public:
  using At = std::array<int, 3>;  // x, y, slice

  explicit TargetVolume(const Problem& problem) : problem_(problem) {}

  /// Along which voxels have neighbours.
  [[nodiscard]] int axes() const { return problem_.stacked ? 3 : 2; }

  [[nodiscard]] bool contains(const At& at) const {
    const Slab& slab = problem_.target[0];
    return at[0] >= 0 && at[0] < slab.width && at[1] >= 0 && at[1] < slab.height && at[2] >= 0 &&
           at[2] < problem_.slices;
  }
  [[nodiscard]] float coverage(const At& at) const {
    if (!contains(at)) return 0.0F;
    const SurfacePoint::Voxel v = voxel(at);
    return problem_.target[v.slab].values[v.i];
  }
  [[nodiscard]] SurfacePoint::Voxel voxel(const At& at) const {
    const auto pixel = static_cast<std::size_t>(at[1]) * problem_.target[0].width + at[0];
    return {static_cast<std::uint32_t>(at[2] / lanes), static_cast<std::uint32_t>(pixel * lanes + at[2] % lanes)};
  }
  [[nodiscard]] static At moved(At at, int axis, int by) {
    at[axis] += by;
    return at;
  }

  /// How steep the coverage is along an axis: differences across the voxel, smoothed by 1, 2, 1 along the others.
  [[nodiscard]] float slope(const At& at, int axis) const {
    const int one = (axis + 1) % 3;
    const int other = (axis + 2) % 3;
    const int along_one = one < axes() ? 1 : 0;
    const int along_other = other < axes() ? 1 : 0;
    float sum = 0;
    for (int u = -along_one; u <= along_one; ++u) {
      for (int v = -along_other; v <= along_other; ++v) {
        const At here = moved(moved(at, one, u), other, v);
        const auto weight = static_cast<float>((2 - std::abs(u)) * (2 - std::abs(v)));
        sum += weight * (coverage(moved(here, axis, 1)) - coverage(moved(here, axis, -1)));
      }
    }
    return sum;
  }

  /// Where the surface is between `at` and the next voxel, 0 to 1: in a row of voxels whose first ones are covered and
  /// whose last ones are not, the surface is as many voxels from the middle of the first as the sum of coverages less a
  /// half. The voxels before and after are added where they are cut, too.
  [[nodiscard]] float share(const At& at, int axis) const {
    const float first = coverage(at);
    const float second = coverage(moved(at, axis, 1));
    const bool falls = first > second;
    const auto inside = [&](float f) { return falls ? f : 1.0F - f; };
    float height = inside(first) + inside(second) - half;
    const float before = inside(coverage(moved(at, axis, -1)));
    const float after = inside(coverage(moved(at, axis, 2)));
    if (before >= inside(first)) height -= 1.0F - before;
    if (after <= inside(second)) height += after;
    return std::clamp(height, 0.0F, 1.0F);
  }

 private:
  const Problem& problem_;
};

bool crosses(float a, float b) { return (a >= half) != (b >= half); }

/// The points that begin in one row of voxels.
class VoxelRow {
 public:
  VoxelRow(const Problem& problem, const TargetVolume& volume) : problem_(problem), volume_(volume) {}

  void find(const TargetVolume::At& at, std::vector<SurfacePoint>& points) const {
    const float here = volume_.coverage(at);
    for (int axis = 0; axis < volume_.axes(); ++axis) {
      const TargetVolume::At next = TargetVolume::moved(at, axis, 1);
      if (!volume_.contains(next) || !crosses(here, volume_.coverage(next))) continue;
      const auto [steepest, cosine] = normal(at, axis);
      if (steepest != axis && crosses_along(at, steepest) && crosses_along(next, steepest)) continue;
      const SurfacePoint::Voxel from = volume_.voxel(at);
      const SurfacePoint::Voxel to = volume_.voxel(next);
      if (!is_lit(from) || !is_lit(to)) continue;
      const float weight = std::min(problem_.weight_at(from.slab, from.i), problem_.weight_at(to.slab, to.i));
      if (weight > 0)
        points.push_back({from, to, volume_.share(at, axis), weight, steepest == axis ? cosine : outwards(here)});
    }
  }

 private:
  /// A wall that the voxels do not resolve stands across the axis of its points.
  static float outwards(float coverage) { return coverage >= half ? 1.0F : -1.0F; }
  struct Normal {
    int steepest;  // axis along which the coverage changes most
    float cosine;  // of the outward normal with the axis of the point
  };
  [[nodiscard]] Normal normal(const TargetVolume::At& at, int axis) const {
    const TargetVolume::At next = TargetVolume::moved(at, axis, 1);
    const auto slope = [&](int along) { return volume_.slope(at, along) + volume_.slope(next, along); };
    const float here = slope(axis);
    int steepest = axis;
    float most = std::abs(here);
    float square = here * here;
    for (int other = 0; other < volume_.axes(); ++other) {
      if (other == axis) continue;
      const float there = slope(other);
      if (std::abs(there) > most || (std::abs(there) == most && other < steepest)) {
        steepest = other;
        most = std::abs(there);
      }
      square += there * there;
    }
    return {steepest, square > 0 ? -here / std::sqrt(square) : 1.0F};
  }
  /// Whether the surface passes between the voxel and a neighbour along the axis.
  [[nodiscard]] bool crosses_along(const TargetVolume::At& at, int axis) const {
    const float here = volume_.coverage(at);
    return crosses(here, volume_.coverage(TargetVolume::moved(at, axis, 1))) ||
           crosses(here, volume_.coverage(TargetVolume::moved(at, axis, -1)));
  }
  [[nodiscard]] bool is_lit(SurfacePoint::Voxel v) const { return problem_.labels[v.slab][v.i] != Label::outside; }

  const Problem& problem_;
  const TargetVolume& volume_;
};

std::vector<CutVoxel> cut_voxels(const Problem& problem) {
  std::vector<std::vector<CutVoxel>> slabs(problem.target.size());
  parallel_for(count_of(slabs), [&](int s) {
    const std::vector<Label>& labels = problem.labels[s];
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const float weight = labels[i] == Label::surface ? problem.weight_at(s, i) : 0.0F;
      if (weight == 0) continue;
      const SurfacePoint::Voxel at{static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(i)};
      slabs[s].push_back({at, weight, model::half_covered(problem.target[s].values[i])});
    }
  });
  std::vector<CutVoxel> all;
  for (const auto& some : slabs) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace

SurfacePoints::SurfacePoints(const Problem& problem)
    : threshold_(static_cast<float>(problem.demands.window.threshold())) {
  if (!asks_surface(problem.demands)) return;
  const Slab& slab = problem.target[0];
  const TargetVolume volume(problem);
  const VoxelRow row(problem, volume);
  const int slabs = count_of(problem.target);
  std::vector<std::vector<SurfacePoint>> rows(product(slabs, slab.height));
  parallel_for(count_of(rows), [&](int n) {
    const int first = n / slab.height * lanes;
    for (int x = 0; x < slab.width; ++x) {
      for (int k = first; k < std::min(first + lanes, problem.slices); ++k) row.find({x, n % slab.height, k}, rows[n]);
    }
  });
  for (const auto& some : rows) points_.insert(points_.end(), some.begin(), some.end());
  cut_ = cut_voxels(problem);
}

std::vector<float> SurfacePoints::misses(std::span<const Slab> dose) const {
  std::vector<float> result(points_.size() + cut_.size());
  const auto at = [&](SurfacePoint::Voxel v) { return dose[v.slab].values[v.i]; };
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const SurfacePoint& p = points_[i];
    result[i] = (1.0F - p.share) * at(p.from) + p.share * at(p.to) - threshold_;
  }
  for (std::size_t i = 0; i < cut_.size(); ++i) {
    const float above = at(cut_[i].at) - threshold_;
    result[points_.size() + i] = cut_[i].is_part ? std::min(above, 0.0F) : std::max(above, 0.0F);
  }
  return result;
}

PerSlice SurfacePoints::losses(std::span<const float> misses, std::size_t slabs) const {
  std::vector<double> sums(slabs * lanes, 0.0);
  const auto add = [&](SurfacePoint::Voxel v, float weight, float miss) {
    sums[v.slab * lanes + v.i % lanes] += 0.5F * weight * miss * miss;
  };
  for (std::size_t i = 0; i < points_.size(); ++i) add(points_[i].from, points_[i].weight, misses[i]);
  for (std::size_t i = 0; i < cut_.size(); ++i) add(cut_[i].at, cut_[i].weight, misses[points_.size() + i]);
  PerSlice result = filled(slabs, 0.0F);
  for (std::size_t k = 0; k < sums.size(); ++k) result[k / lanes][k % lanes] = static_cast<float>(sums[k]);
  return result;
}

SurfaceMiss SurfacePoints::miss(std::span<const Slab> dose) const {
  const std::vector<float> missed = misses(dose);
  double area = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const SurfacePoint& p = points_[i];
    const float step = dose[p.to.slab].values[p.to.i] - dose[p.from.slab].values[p.from.i];
    const float falls = p.cosine < 0 ? step : -step;  // outwards, per voxel along the axis
    const float along = std::abs(missed[i]) < falls ? missed[i] / falls : std::copysign(1.0F, missed[i]);
    const auto cosine = static_cast<double>(std::abs(p.cosine));
    const double away = cosine * static_cast<double>(along);
    area += 1 / cosine;
    sum += away / cosine;
    squares += away * away / cosine;
  }
  return {sum / area, std::sqrt(squares / area)};
}

void SurfacePoints::add_slopes(std::span<const float> misses, std::span<Slab> slopes, float share) const {
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const SurfacePoint& p = points_[i];
    const float slope = share * p.weight * misses[i];
    slopes[p.from.slab].values[p.from.i] += (1.0F - p.share) * slope;
    slopes[p.to.slab].values[p.to.i] += p.share * slope;
  }
  for (std::size_t i = 0; i < cut_.size(); ++i) {
    const CutVoxel& cut = cut_[i];
    slopes[cut.at.slab].values[cut.at.i] += share * cut.weight * misses[points_.size() + i];
  }
}

}  // namespace vam::optimize

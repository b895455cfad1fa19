// SPDX-License-Identifier: GPL-3.0-or-later
// Adjoint: outputs are pixels, input rows are eight angles. A tile of pixels stays in L2 while all angles pass over it;
// the stretch of eight angles that it sees is copied side by side first, so that the kernel's rows do not share cache
// sets.
#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "tomo/private/radon_plan.hpp"

namespace vam::tomo {

namespace {

constexpr int tile_edge = 64;    // pixels, both ways
constexpr int window_bins = 97;  // bins that a tile can see: 63 * sqrt(2) + 1.42 + 1, the taps, rounding up
constexpr int gather_taps = 3;

/// e^{-alpha (x - axis) sin} and e^{alpha (y - axis) cos} as [block of eight angles][pixel][angle].
struct Factors {
  std::vector<float> x;  // nx + 1 pixels: one more, for the kernel's pairs
  std::vector<float> y;
};

std::size_t factor_at(std::size_t block, int pixel, int pixels) {
  return (block * static_cast<std::size_t>(pixels) + pixel) * kernel_rows;
}

/// Eight angles as one tile sees them.
struct Stretch {
  GatherRows from{};
  std::array<int, kernel_rows> origin{};  // the bin in element 0
  std::array<int, kernel_rows> skip{};    // elements before the detector begins
};

class Adjoint {
 public:
  Adjoint(const ParallelGeometry& geometry, std::span<const Slab> sinograms, std::span<Slab> images, Simd level)
      : geometry_(geometry),
        sinograms_(sinograms),
        images_(images),
        plan_(make_plan(geometry, images, sinograms)),
        groups_(make_groups(images.size())),
        kernels_(radon_kernels(level)),
        footprints_((plan_.rays.size() + kernel_rows - 1) / kernel_rows) {
    make_footprints();
    if (geometry.alpha_per_px != 0) make_factors();
  }

  void run() const {
    const int across = (geometry_.nx + tile_edge - 1) / tile_edge;
    const int down = (geometry_.ny + tile_edge - 1) / tile_edge;
    parallel_for(count_of(groups_) * across * down, [&](int item) {
      const SlabGroup& group = groups_[item / (across * down)];
      work_out_tile(group, item % across * tile_edge, item / across % down * tile_edge);
    });
  }

 private:
  void make_footprints() {
    for (std::size_t a = 0; a < footprints_.size() * kernel_rows; ++a) {
      const bool there = a < plan_.rays.size();  // the last block's other rows weigh nothing
      const Ray ray = there ? plan_.rays[a] : Ray{1, 0, 0};
      const double c = std::abs(ray.cosine);
      const double s = std::abs(ray.sine);
      set_footprint(footprints_[a / kernel_rows], a % kernel_rows, std::max(c, s), std::min(c, s), there ? 1 : 0,
                    ray.cosine);
    }
  }

  void make_factors() {
    const double alpha = geometry_.alpha_per_px;
    const int width = geometry_.nx + 1;
    factors_.x.assign(factor_at(footprints_.size(), 0, width), 1.0F);
    factors_.y.assign(factor_at(footprints_.size(), 0, geometry_.ny), 1.0F);
    parallel_for(count_of(plan_.rays), [&](int angle) {
      const auto a = static_cast<std::size_t>(angle);
      const Ray& ray = plan_.rays[a];
      for (int i = 0; i < width; ++i) {
        factors_.x[factor_at(a / kernel_rows, i, width) + a % kernel_rows] =
            static_cast<float>(std::exp(-alpha * (i - geometry_.axis_x) * ray.sine));
      }
      for (int j = 0; j < geometry_.ny; ++j) {
        factors_.y[factor_at(a / kernel_rows, j, geometry_.ny) + a % kernel_rows] =
            static_cast<float>(std::exp(alpha * (j - geometry_.axis_y) * ray.cosine));
      }
    });
  }

  void work_out_tile(const SlabGroup& group, int x0, int y0) const {
    const std::ptrdiff_t pitch = group.pitch();
    float* bins = scratch(0, kernel_rows * window_bins * group_lanes);
    float* pixels = scratch(1, std::size_t{tile_edge} * tile_edge * group_lanes);
    std::fill_n(pixels, std::ptrdiff_t{tile_edge} * tile_edge * pitch, 0.0F);
    const int x1 = std::min(x0 + tile_edge, geometry_.nx);
    const int y1 = std::min(y0 + tile_edge, geometry_.ny);
    const int calls = (y1 - y0) * ((x1 - x0 + segment - 1) / segment);
    const auto attenuation = geometry_.alpha_per_px == 0 ? plain : by_output;

    Stretch next = find(group, 0, x0, y0);
    for (std::size_t block = 0; block < footprints_.size(); ++block) {
      const Stretch now = next;
      copy(now, bins, pitch);
      next = find(group, std::min(block + 1, footprints_.size() - 1), x0, y0);
      Ahead ahead(next.from, calls);
      Gather job;
      job.footprints = &footprints_[block];
      job.input = bins;
      job.last = window_bins - gather_taps;
      job.output_step = pitch;
      for (int e = 0; e < pair_entries; ++e)
        job.row_offset[e] = e % gather_rows * window_bins * static_cast<int>(pitch);
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; x += segment) {
          place(job, block, now, x, y);
          job.outputs = std::min(segment, x1 - x);
          float* to = pixels + (std::ptrdiff_t{y - y0} * tile_edge + x - x0) * pitch;
          for (std::size_t s = 0; s < group.slabs; ++s) job.output[s] = to + s * lanes;
          kernels_.gather[group.log2()][gather_taps - 3][attenuation](job);
          ahead.fetch_share();
        }
      }
    }
    for (int y = y0; y < y1; ++y) put(group, pixels + std::ptrdiff_t{y - y0} * tile_edge * pitch, x0, x1, y);
  }

  /// Where the bins of a block's angles lie that the tile sees, opposite angles to be added when the plan is folded.
  [[nodiscard]] Stretch find(const SlabGroup& group, std::size_t block, int x0, int y0) const {
    Stretch stretch;
    for (std::size_t r = 0; r < kernel_rows; ++r) {
      Interleave& job = stretch.from[r];
      job.slabs = static_cast<int>(group.slabs);
      job.from_step = lanes;
      job.plus_step = -lanes;
      const std::size_t a = block * kernel_rows + r;
      if (a >= plan_.rays.size()) continue;
      const Ray& ray = plan_.rays[a];
      const double left = std::min(0.0, ray.cosine * (tile_edge - 1)) + std::min(0.0, ray.sine * (tile_edge - 1));
      const int origin = floor_int(x0 * ray.cosine + y0 * ray.sine + ray.offset + left) - 2;
      const int first = std::clamp(-origin, 0, window_bins);
      stretch.origin[r] = origin;
      stretch.skip[r] = first;
      job.count = std::clamp(geometry_.columns - origin, first, window_bins) - first;
      if (job.count == 0) continue;
      const int angle = static_cast<int>(a);
      for (std::size_t s = 0; s < group.slabs; ++s) {
        const Slab& slab = sinograms_[group.first + s];
        job.from[s] = slab.at(origin + first, angle);
        if (plan_.folded) job.plus[s] = slab.at(geometry_.columns - 1 - origin - first, angle + geometry_.angles / 2);
      }
    }
    return stretch;
  }

  /// Copies them side by side, zero where there is no detector.
  void copy(const Stretch& stretch, float* bins, std::ptrdiff_t pitch) const {
    for (std::size_t r = 0; r < kernel_rows; ++r) {
      Interleave job = stretch.from[r];
      const std::ptrdiff_t first = stretch.skip[r];
      const std::ptrdiff_t last = first + job.count;
      std::fill_n(bins, first * pitch, 0.0F);
      std::fill_n(bins + last * pitch, (window_bins - last) * pitch, 0.0F);
      job.to = bins + first * pitch;
      if (job.count > 0) kernels_.interleave(job);
      bins += window_bins * pitch;
    }
  }

  /// The job's first pixel is (x, y).
  void place(Gather& job, std::size_t block, const Stretch& stretch, int x, int y) const {
    for (std::size_t r = 0; r < kernel_rows; ++r) {
      const Ray& ray = plan_.rays[std::min(block * kernel_rows + r, plan_.rays.size() - 1)];
      set_first(job, r, x * ray.cosine + y * ray.sine + ray.offset - stretch.origin[r]);
    }
    if (geometry_.alpha_per_px == 0) return;
    job.factor = factors_.x.data() + factor_at(block, x, geometry_.nx + 1);
    const float* along_y = factors_.y.data() + factor_at(block, y, geometry_.ny);
    for (std::size_t e = 0; e < pair_entries; ++e) job.row_factor[e] = along_y[e % kernel_rows];
  }

  void put(const SlabGroup& group, const float* pixels, int x0, int x1, int y) const {
    for (std::size_t s = 0; s < group.slabs; ++s) {
      float* to = images_[group.first + s].at(x0, y);
      const float* from = pixels + s * lanes;
      for (int x = x0; x < x1; ++x, to += lanes, from += group.pitch()) std::copy_n(from, lanes, to);
    }
  }

  const ParallelGeometry& geometry_;
  std::span<const Slab> sinograms_;
  std::span<Slab> images_;
  Plan plan_;
  std::vector<SlabGroup> groups_;
  const RadonKernels& kernels_;
  std::vector<Footprints> footprints_;  // per block of eight angles
  Factors factors_;
};

}  // namespace

void adjoint(const ParallelGeometry& geometry, std::span<const Slab> sinograms, std::span<Slab> images, Simd level) {
  Adjoint(geometry, sinograms, images, level).run();
}

}  // namespace vam::tomo

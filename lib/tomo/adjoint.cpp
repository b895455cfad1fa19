// Adjoint: outputs are pixels, input rows are eight angles. A tile of pixels stays in L2 while all angles pass over it;
// the stretch of eight angles that it sees is copied side by side first, so that the kernel's rows do not share cache
// sets.
#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "tomo/radon_plan.hpp"

namespace vam::tomo {

namespace {

constexpr int tile = 32;     // pixels, both ways
constexpr int segment = 16;  // pixels a call; their bins of eight angles fit in L1
constexpr int window = 52;   // bins that a tile can see: 31 * sqrt(2) + 1.42 + 1, the taps, rounding up
constexpr int taps = 3;

/// e^{-alpha (x - axis) sin} and e^{alpha (y - axis) cos}, for one block of eight angles: [pixel][angle].
struct Factors {
  std::vector<float> x;  // [block][nx + 1][8]; one more pixel, for an odd pair
  std::vector<float> y;  // [block][ny][8]
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
        blocks_((static_cast<int>(plan_.rays.size()) + gather_rows - 1) / gather_rows) {
    make_footprints();
    if (geometry.alpha_per_px != 0) make_factors();
  }

  void run() const {
    const int across = (geometry_.nx + tile - 1) / tile;
    const int down = (geometry_.ny + tile - 1) / tile;
    parallel_for(static_cast<int>(groups_.size()) * across * down, [&](int item) {
      const Group& group = groups_[static_cast<std::size_t>(item / (across * down))];
      const int x = item % across * tile;
      const int y = item / across % down * tile;
      work_out_tile(group, x, y);
    });
  }

 private:
  void make_footprints() {
    footprints_.resize(static_cast<std::size_t>(blocks_));
    for (int a = 0; a < blocks_ * gather_rows; ++a) {
      Footprints& footprints = footprints_[static_cast<std::size_t>(a / gather_rows)];
      const bool there = a < static_cast<int>(plan_.rays.size());
      const Ray ray = there ? plan_.rays[static_cast<std::size_t>(a)] : Ray{1, 0, 0};
      const double c = std::abs(ray.cosine);
      const double s = std::abs(ray.sine);
      set_footprint(footprints, a % gather_rows, std::max(c, s), std::min(c, s), there ? 1 : 0, ray.cosine);
    }
  }

  void make_factors() {
    const double alpha = geometry_.alpha_per_px;
    const int width = geometry_.nx + 1;
    factors_.x.assign(static_cast<std::size_t>(blocks_) * static_cast<std::size_t>(width) * gather_rows, 1.0F);
    factors_.y.assign(static_cast<std::size_t>(blocks_) * static_cast<std::size_t>(geometry_.ny) * gather_rows, 1.0F);
    parallel_for(static_cast<int>(plan_.rays.size()), [&](int a) {
      const Ray& ray = plan_.rays[static_cast<std::size_t>(a)];
      float* x = factors_.x.data() + at(a / gather_rows, 0, width) + a % gather_rows;
      for (int i = 0; i < width; ++i) {
        x[i * gather_rows] = static_cast<float>(std::exp(-alpha * (i - geometry_.axis_x) * ray.sine));
      }
      float* y = factors_.y.data() + at(a / gather_rows, 0, geometry_.ny) + a % gather_rows;
      for (int j = 0; j < geometry_.ny; ++j) {
        y[j * gather_rows] = static_cast<float>(std::exp(alpha * (j - geometry_.axis_y) * ray.cosine));
      }
    });
  }

  static std::size_t at(int block, int pixel, int pixels) {
    return (static_cast<std::size_t>(block) * static_cast<std::size_t>(pixels) + static_cast<std::size_t>(pixel)) *
           gather_rows;
  }

  void work_out_tile(const Group& group, int x0, int y0) const {
    const int pitch = group.pitch();
    Buffer& bins = scratch(0, static_cast<std::size_t>(gather_rows) * window * group_lanes);
    Buffer& pixels = scratch(1, static_cast<std::size_t>(tile) * tile * group_lanes);
    std::fill_n(pixels.begin(), tile * tile * pitch, 0.0F);
    const int x1 = std::min(x0 + tile, geometry_.nx);
    const int y1 = std::min(y0 + tile, geometry_.ny);
    const auto attenuation = geometry_.alpha_per_px == 0 ? plain : by_output;
    for (int block = 0; block < blocks_; ++block) {
      int origin[gather_rows];
      for (int r = 0; r < gather_rows; ++r) origin[r] = copy_bins(group, block * gather_rows + r, x0, y0, bins.data());
      Gather job;
      job.footprints = &footprints_[static_cast<std::size_t>(block)];
      job.input = bins.data();
      job.last = window - taps;
      job.output_step = pitch;
      for (int e = 0; e < pair_entries; ++e) job.row_offset[e] = e % gather_rows * window * pitch;
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; x += segment) {
          prepare(job, block, origin, x, y);
          job.outputs = std::min(segment, x1 - x);
          float* to = pixels.data() + ((y - y0) * tile + x - x0) * pitch;
          for (int s = 0; s < group.slabs; ++s) job.output[s] = to + s * lanes;
          kernels_.gather[group.log2()][taps - 3][attenuation](job);
        }
      }
    }
    for (int y = y0; y < y1; ++y) {
      for (int s = 0; s < group.slabs; ++s) {
        float* to = images_[static_cast<std::size_t>(group.first + s)].at(x0, y);
        const float* from = pixels.data() + (y - y0) * tile * pitch + s * lanes;
        for (int i = 0; i < x1 - x0; ++i) std::copy_n(from + i * pitch, lanes, to + i * lanes);
      }
    }
  }

  void prepare(Gather& job, int block, const int* origin, int x, int y) const {
    const int rays = static_cast<int>(plan_.rays.size());
    for (int r = 0; r < gather_rows; ++r) {
      const int a = std::min(block * gather_rows + r, rays - 1);
      const Ray& ray = plan_.rays[static_cast<std::size_t>(a)];
      set_first(job, r, x * ray.cosine + y * ray.sine + ray.offset - origin[r]);
    }
    if (geometry_.alpha_per_px == 0) return;
    job.factor = factors_.x.data() + at(block, x, geometry_.nx + 1);
    const float* row = factors_.y.data() + at(block, y, geometry_.ny);
    for (int e = 0; e < pair_entries; ++e) job.row_factor[e] = row[e % gather_rows];
  }

  /// Copies the bins of one angle that the tile sees, zero where there is no detector; returns the first bin's number.
  int copy_bins(const Group& group, int a, int x0, int y0, float* bins) const {
    const int pitch = group.pitch();
    float* row = bins + (a % gather_rows) * window * pitch;
    if (a >= static_cast<int>(plan_.rays.size())) {
      std::fill_n(row, window * pitch, 0.0F);
      return 0;
    }
    const Ray& ray = plan_.rays[static_cast<std::size_t>(a)];
    const double left = std::min(0.0, ray.cosine * (tile - 1)) + std::min(0.0, ray.sine * (tile - 1));
    const int origin = static_cast<int>(std::floor(x0 * ray.cosine + y0 * ray.sine + ray.offset + left)) - 2;
    const int first = std::clamp(-origin, 0, window);
    const int last = std::clamp(geometry_.columns - origin, first, window);
    std::fill_n(row, first * pitch, 0.0F);
    std::fill_n(row + last * pitch, (window - last) * pitch, 0.0F);
    Interleave job{};
    job.slabs = group.slabs;
    job.count = last - first;
    job.to = row + first * pitch;
    job.from_step = lanes;
    job.plus_step = -lanes;
    if (job.count == 0) return origin;
    for (int s = 0; s < group.slabs; ++s) {
      const Slab& slab = sinograms_[static_cast<std::size_t>(group.first + s)];
      job.from[s] = slab.at(origin + first, a);
      if (plan_.folded) job.plus[s] = slab.at(geometry_.columns - 1 - origin - first, a + geometry_.angles / 2);
    }
    kernels_.interleave(job);
    return origin;
  }

  const ParallelGeometry& geometry_;
  std::span<const Slab> sinograms_;
  std::span<Slab> images_;
  Plan plan_;
  std::vector<Group> groups_;
  const RadonKernels& kernels_;
  int blocks_;
  std::vector<Footprints> footprints_;
  Factors factors_;
};

}  // namespace

void adjoint(const ParallelGeometry& geometry, std::span<const Slab> sinograms, std::span<Slab> images, Simd level) {
  Adjoint(geometry, sinograms, images, level).run();
}

}  // namespace vam::tomo

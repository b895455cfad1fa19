// SPDX-License-Identifier: GPL-3.0-or-later
// Forward: outputs are detector bins, input rows are eight rows of pixels. Seen from the bins, a strip of width 1
// crosses a row of pixels in a trapezoid too, so that the kernel of the adjoint serves again, and no bin is written
// twice a row. Rays within 45 degrees of the y axis take rows along x, the others rows along y ("major" is the axis
// along the row).
#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "tomo/private/radon_plan.hpp"

namespace vam::tomo {

namespace {

constexpr std::size_t most_angles = 32;  // angles that pass over a band while it is in cache
constexpr int band = 128;                // pixels along the rows; a band has eight rows
constexpr int pad = 4;                   // zeros on both sides: bins see at most 4 pixels of a row
constexpr int row_elements = band + 2 * pad;

/// One angle: t = p * cp + q * cq + offset, p along the rows, q across them; e^{alpha u} = major[p] * minor[q].
struct AngleView {
  int angle;
  double cp;
  double cq;
  double offset;
  Footprints footprints;
  std::vector<float> major;  // [pad + p]
  std::vector<float> minor;
};

/// Some angles with the same major axis and number of taps.
struct AngleBlock {
  bool x_major;
  std::size_t taps;
  std::vector<int> angles;
};

class Forward {
 public:
  Forward(const ParallelGeometry& geometry, std::span<const Slab> images, std::span<Slab> sinograms, Simd level)
      : geometry_(geometry),
        images_(images),
        sinograms_(sinograms),
        plan_(make_plan(geometry, images, sinograms)),
        groups_(make_groups(images.size())),
        kernels_(radon_kernels(level)) {
    make_blocks();
  }

  void run() const {
    const std::size_t blocks = blocks_.size();
    parallel_for(static_cast<int>(groups_.size() * blocks), [&](int item) {
      const auto i = static_cast<std::size_t>(item);
      work_out_block(groups_[i / blocks], blocks_[i % blocks]);
    });
  }

 private:
  void make_blocks() {
    // Four work items a thread at least, when there are enough angles; the result does not depend on it.
    const std::size_t items = 4 * static_cast<std::size_t>(threads());
    const std::size_t block_angles =
        std::clamp<std::size_t>(plan_.rays.size() * groups_.size() / items, 8, most_angles);
    for (std::size_t a = 0; a < plan_.rays.size(); ++a) {
      const double c = std::abs(plan_.rays[a].cosine);
      const double s = std::abs(plan_.rays[a].sine);
      const bool x_major = c >= s;
      // A strip of width 1 covers (1 + narrow) / wide of a row, so up to 3 pixels while that is at most 2, else 4.
      const std::size_t taps = 1 + std::min(c, s) <= 2 * std::max(c, s) ? 3 : 4;
      if (blocks_.empty() || blocks_.back().x_major != x_major || blocks_.back().taps != taps ||
          blocks_.back().angles.size() == block_angles) {
        blocks_.push_back({x_major, taps, {}});
      }
      blocks_.back().angles.push_back(static_cast<int>(a));
    }
  }

  [[nodiscard]] int major_size(const AngleBlock& block) const { return block.x_major ? geometry_.nx : geometry_.ny; }
  [[nodiscard]] int minor_size(const AngleBlock& block) const { return block.x_major ? geometry_.ny : geometry_.nx; }

  [[nodiscard]] AngleView make_view(const AngleBlock& block, int angle) const {
    const Ray& ray = plan_.rays[angle];
    AngleView view{};
    view.angle = angle;
    view.cp = block.x_major ? ray.cosine : ray.sine;
    view.cq = block.x_major ? ray.sine : ray.cosine;
    view.offset = ray.offset;
    const double wide = 1 / std::abs(view.cp);
    for (std::size_t r = 0; r < kernel_rows; ++r) {
      set_footprint(view.footprints, r, wide, std::abs(view.cq) * wide, wide, 1 / view.cp);
    }
    if (geometry_.alpha_per_px != 0) set_factors(view, block, ray);
    return view;
  }

  void set_factors(AngleView& view, const AngleBlock& block, const Ray& ray) const {
    const double alpha = geometry_.alpha_per_px;
    const auto along = [alpha](int pixels, double axis, double slope) {
      std::vector<float> factors(pixels);
      for (int i = 0; i < pixels; ++i) {
        factors[i] = static_cast<float>(std::exp(alpha * (i - axis) * slope));
      }
      return factors;
    };
    const std::vector<float> x = along(geometry_.nx, geometry_.axis_x, -ray.sine);
    const std::vector<float> y = along(geometry_.ny, geometry_.axis_y, ray.cosine);
    view.major = block.x_major ? x : y;
    view.minor = block.x_major ? y : x;
    view.major.insert(view.major.begin(), pad, 0.0F);
    view.major.resize(view.major.size() + band + pad);
    view.minor.resize(view.minor.size() + kernel_rows);
  }

  void work_out_block(const SlabGroup& group, const AngleBlock& block) const {
    std::vector<AngleView> views;
    for (const int angle : block.angles) {
      views.push_back(make_view(block, angle));
      for (Slab& sinogram : sinograms_.subspan(group.first, group.slabs)) {
        std::fill_n(sinogram.at(0, angle), geometry_.columns * lanes, 0.0F);
      }
    }
    const int np = major_size(block);
    const int nq = minor_size(block);
    float* pixels = scratch(0, kernel_rows * row_elements * group_lanes);
    GatherRows next = find(group, block, 0, 0);
    for (int q = 0; q < nq; q += gather_rows) {
      for (int p = 0; p < np; p += band) {
        const GatherRows now = next;
        next = p + band < np ? find(group, block, p + band, q) : find(group, block, 0, q + gather_rows);
        if (!copy(now, pixels, group.pitch())) continue;
        Ahead ahead(next, band / segment * count_of(views));
        for (int m = 0; m < band; m += segment) {
          for (const AngleView& view : views) {
            project(group, block, view, p, q, find_bins(view, p, q, m), pixels);
            ahead.fetch_share();
          }
        }
      }
    }
    if (!plan_.folded) return;
    for (const int angle : block.angles) mirror(group, angle);
  }

  struct BinRange {
    int first;
    int last;  // one past
  };

  /// The bins whose strips cross the middle of the band in pixels [m, m + segment); the first and last segment also
  /// take the bins that only touch the band.
  [[nodiscard]] BinRange find_bins(const AngleView& view, int p0, int q0, int m) const {
    const double middle = p0 * view.cp + (q0 + 0.5 * (gather_rows - 1)) * view.cq + view.offset;
    const double margin = 0.5 * (gather_rows * std::abs(view.cq) + std::abs(view.cp) + 1);
    const bool rising = view.cp > 0;
    double low = middle + (rising ? m : m + segment) * view.cp;
    double high = middle + (rising ? m + segment : m) * view.cp;
    if (m == (rising ? 0 : band - segment)) low -= margin;
    if (m == (rising ? band - segment : 0)) high += margin;
    return {std::max(0, ceil_int(low)), std::min(geometry_.columns, ceil_int(high))};
  }

  /// Adds the band's pixels to these bins.
  void project(const SlabGroup& group, const AngleBlock& block, const AngleView& view, int p0, int q0, BinRange bins,
               const float* pixels) const {
    if (bins.first >= bins.last) return;
    const double t0 = p0 * view.cp + q0 * view.cq + view.offset;  // of the band's first pixel
    Gather job;
    job.footprints = &view.footprints;
    job.input = pixels;
    job.last = static_cast<float>(row_elements - static_cast<int>(block.taps));
    job.outputs = bins.last - bins.first;
    job.output_step = lanes;
    const double per_bin = 1 / view.cp;
    for (std::size_t r = 0; r < kernel_rows; ++r) {
      set_first(job, r, (bins.first - t0 - static_cast<double>(r) * view.cq) * per_bin + pad);
    }
    for (int e = 0; e < pair_entries; ++e) {
      job.row_offset[e] = e % gather_rows * row_elements * static_cast<int>(group.pitch());
    }
    for (std::size_t s = 0; s < group.slabs; ++s)
      job.output[s] = sinograms_[group.first + s].at(bins.first, view.angle);
    const bool attenuated = geometry_.alpha_per_px != 0;
    if (attenuated) {
      job.factor = view.major.data() + p0;
      const float* across = view.minor.data() + q0;
      for (std::size_t e = 0; e < pair_entries; ++e) job.row_factor[e] = across[e % kernel_rows];
    }
    kernels_.gather[group.log2()][block.taps - 3][attenuated ? by_element : plain](job);
  }

  /// Where eight rows of pixels lie; rows beyond the image have no pixels.
  [[nodiscard]] GatherRows find(const SlabGroup& group, const AngleBlock& block, int p0, int q0) const {
    const int np = std::min(band, major_size(block) - p0);
    const int nq = std::min(gather_rows, minor_size(block) - q0);
    GatherRows found{};
    for (int r = 0; r < gather_rows; ++r) {
      Interleave& job = found[r];
      job.slabs = static_cast<int>(group.slabs);
      job.count = r < nq ? np : 0;
      job.from_step = block.x_major ? lanes : static_cast<long>(geometry_.nx) * lanes;
      for (std::size_t s = 0; s < group.slabs && r < nq; ++s) {
        const Slab& slab = images_[group.first + s];
        job.from[s] = block.x_major ? slab.at(p0, q0 + r) : slab.at(q0 + r, p0);
      }
    }
    return found;
  }

  /// Copies them side by side, zeros around them; false when all of them are zero.
  [[nodiscard]] bool copy(const GatherRows& found, float* pixels, std::ptrdiff_t pitch) const {
    bool any = false;
    for (Interleave job : found) {
      std::fill_n(pixels, pad * pitch, 0.0F);
      std::fill_n(pixels + (pad + job.count) * pitch, (row_elements - pad - job.count) * pitch, 0.0F);
      job.to = pixels + pad * pitch;
      any = (job.count > 0 && kernels_.interleave(job)) || any;
      pixels += row_elements * pitch;
    }
    return any;
  }

  void mirror(const SlabGroup& group, int angle) const {
    for (Slab& slab : sinograms_.subspan(group.first, group.slabs)) {
      const float* from = slab.at(0, angle);
      float* to = slab.at(geometry_.columns - 1, angle + geometry_.angles / 2);
      for (int c = 0; c < geometry_.columns; ++c, from += lanes, to -= lanes) std::copy_n(from, lanes, to);
    }
  }

  const ParallelGeometry& geometry_;
  std::span<const Slab> images_;
  std::span<Slab> sinograms_;
  Plan plan_;
  std::vector<SlabGroup> groups_;
  const RadonKernels& kernels_;
  std::vector<AngleBlock> blocks_;
};

}  // namespace

void forward(const ParallelGeometry& geometry, std::span<const Slab> images, std::span<Slab> sinograms, Simd level) {
  Forward(geometry, images, sinograms, level).run();
}

}  // namespace vam::tomo

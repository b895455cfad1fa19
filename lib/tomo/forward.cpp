// Forward: outputs are detector bins, input rows are eight rows of pixels. Seen from the bins, a strip of width 1
// crosses a row of pixels in a trapezoid too, so that the kernel of the adjoint serves again, and no bin is written
// twice a row. Rays within 45 degrees of the y axis take rows along x, the others rows along y ("major" is the axis
// along the row).
#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "tomo/radon_plan.hpp"

namespace vam::tomo {

namespace {

constexpr int block_angles = 16;  // angles that pass over a band while it is in cache
constexpr int band = 64;          // pixels along the rows; a band has eight rows
constexpr int segment = 16;       // pixels whose bins make one call; eight rows of them fit in L1
constexpr int pad = 4;            // zeros on both sides: bins see at most 4 pixels of a row
constexpr int row_elements = band + 2 * pad;

/// Some angles with the same major axis: p runs along the rows, q across them.
struct Block {
  bool x_major;
  int taps;
  std::vector<int> angles;
};

/// t = p * cp + q * cq + offset; e^{alpha u} = major[p] * minor[q].
struct View {
  int angle;
  double cp;
  double cq;
  double offset;
  Footprints footprints;
  std::vector<float> major;  // [pad + p]
  std::vector<float> minor;
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
    const int blocks = static_cast<int>(blocks_.size());
    parallel_for(static_cast<int>(groups_.size()) * blocks, [&](int item) {
      work_out_block(groups_[static_cast<std::size_t>(item / blocks)],
                     blocks_[static_cast<std::size_t>(item % blocks)]);
    });
  }

 private:
  void make_blocks() {
    // A strip of width 1 covers (1 + narrow) / wide of a row, so up to 3 pixels while that is at most 2, else 4.
    const auto taps_of = [](double wide, double narrow) { return 1 + narrow <= 2 * wide ? 3 : 4; };
    for (int a = 0; a < static_cast<int>(plan_.rays.size()); ++a) {
      const Ray& ray = plan_.rays[static_cast<std::size_t>(a)];
      const double c = std::abs(ray.cosine);
      const double s = std::abs(ray.sine);
      const bool x_major = c >= s;
      const int taps = taps_of(std::max(c, s), std::min(c, s));
      if (blocks_.empty() || blocks_.back().x_major != x_major || blocks_.back().taps != taps ||
          blocks_.back().angles.size() == block_angles) {
        blocks_.push_back({x_major, taps, {}});
      }
      blocks_.back().angles.push_back(a);
    }
  }

  [[nodiscard]] View make_view(const Block& block, int angle) const {
    const Ray& ray = plan_.rays[static_cast<std::size_t>(angle)];
    View view{};
    view.angle = angle;
    view.cp = block.x_major ? ray.cosine : ray.sine;
    view.cq = block.x_major ? ray.sine : ray.cosine;
    view.offset = ray.offset;
    const double wide = 1 / std::abs(view.cp);
    for (int r = 0; r < gather_rows; ++r) {
      set_footprint(view.footprints, r, wide, std::abs(view.cq) * wide, wide, 1 / view.cp);
    }
    if (geometry_.alpha_per_px != 0) set_factors(view, block.x_major, ray);
    return view;
  }

  void set_factors(View& view, bool x_major, const Ray& ray) const {
    const double alpha = geometry_.alpha_per_px;
    const int np = x_major ? geometry_.nx : geometry_.ny;
    const int nq = x_major ? geometry_.ny : geometry_.nx;
    const auto along_x = [&](int i) { return std::exp(-alpha * (i - geometry_.axis_x) * ray.sine); };
    const auto along_y = [&](int j) { return std::exp(alpha * (j - geometry_.axis_y) * ray.cosine); };
    view.major.assign(static_cast<std::size_t>(np + band + 2 * pad), 0.0F);
    view.minor.assign(static_cast<std::size_t>(nq + gather_rows), 0.0F);
    for (int p = 0; p < np; ++p) {
      view.major[static_cast<std::size_t>(p + pad)] = static_cast<float>(x_major ? along_x(p) : along_y(p));
    }
    for (int q = 0; q < nq; ++q)
      view.minor[static_cast<std::size_t>(q)] = static_cast<float>(x_major ? along_y(q) : along_x(q));
  }

  void work_out_block(const Group& group, const Block& block) const {
    std::vector<View> views;
    for (const int angle : block.angles) views.push_back(make_view(block, angle));
    for (const int angle : block.angles) {
      for (int s = 0; s < group.slabs; ++s) {
        std::fill_n(sinograms_[static_cast<std::size_t>(group.first + s)].at(0, angle), geometry_.columns * lanes,
                    0.0F);
      }
    }
    const int np = block.x_major ? geometry_.nx : geometry_.ny;
    const int nq = block.x_major ? geometry_.ny : geometry_.nx;
    Buffer& pixels = scratch(0, static_cast<std::size_t>(gather_rows) * row_elements * group_lanes);
    for (int q = 0; q < nq; q += gather_rows) {
      for (int p = 0; p < np; p += band) {
        if (!copy_band(group, block, p, q, pixels.data())) continue;
        for (int m = 0; m < band; m += segment) {
          for (const View& view : views) project_segment(group, block, view, p, q, m, pixels.data());
        }
      }
    }
    if (plan_.folded) {
      for (const int angle : block.angles) mirror(group, angle);
    }
  }

  /// Adds the bins whose strips cross the middle of the band in pixels [m, m + segment); the first and last segment
  /// also take the bins that only touch the band.
  void project_segment(const Group& group, const Block& block, const View& view, int p0, int q0, int m,
                       const float* pixels) const {
    const double t0 = p0 * view.cp + q0 * view.cq + view.offset;  // of the band's first pixel
    const double middle = t0 + 0.5 * (gather_rows - 1) * view.cq;
    const double margin = 0.5 * (gather_rows * std::abs(view.cq) + std::abs(view.cp) + 1);
    const bool rising = view.cp > 0;
    double low = middle + (rising ? m : m + segment) * view.cp;
    double high = middle + (rising ? m + segment : m) * view.cp;
    if (m == (rising ? 0 : band - segment)) low -= margin;
    if (m == (rising ? band - segment : 0)) high += margin;
    const int first = std::max(0, static_cast<int>(std::ceil(low)));
    const int last = std::min(geometry_.columns, static_cast<int>(std::ceil(high)));
    if (first >= last) return;
    Gather job;
    job.footprints = &view.footprints;
    job.input = pixels;
    job.last = static_cast<float>(row_elements - block.taps);
    job.outputs = last - first;
    job.output_step = lanes;
    for (int r = 0; r < gather_rows; ++r) set_first(job, r, (first - t0 - r * view.cq) / view.cp + pad);
    for (int e = 0; e < pair_entries; ++e) job.row_offset[e] = e % gather_rows * row_elements * group.pitch();
    for (int s = 0; s < group.slabs; ++s) {
      job.output[s] = sinograms_[static_cast<std::size_t>(group.first + s)].at(first, view.angle);
    }
    const auto attenuation = geometry_.alpha_per_px == 0 ? plain : by_element;
    if (attenuation != plain) {
      job.factor = view.major.data() + p0;
      for (int e = 0; e < pair_entries; ++e)
        job.row_factor[e] = view.minor[static_cast<std::size_t>(q0 + e % gather_rows)];
    }
    kernels_.gather[group.log2()][block.taps - 3][attenuation](job);
  }

  /// Copies eight rows of pixels side by side, zero outside the image; false when all of them are zero.
  bool copy_band(const Group& group, const Block& block, int p0, int q0, float* pixels) const {
    const int np = std::min(band, (block.x_major ? geometry_.nx : geometry_.ny) - p0);
    const int nq = std::min(gather_rows, (block.x_major ? geometry_.ny : geometry_.nx) - q0);
    const int pitch = group.pitch();
    bool any = false;
    for (int r = 0; r < gather_rows; ++r) {
      float* row = pixels + r * row_elements * pitch;
      const int count = r < nq ? np : 0;
      std::fill_n(row, pad * pitch, 0.0F);
      std::fill_n(row + (pad + count) * pitch, (row_elements - pad - count) * pitch, 0.0F);
      if (count == 0) continue;
      Interleave job{};
      job.slabs = group.slabs;
      job.count = count;
      job.to = row + pad * pitch;
      job.from_step = block.x_major ? lanes : static_cast<long>(geometry_.nx) * lanes;
      for (int s = 0; s < group.slabs; ++s) {
        const Slab& slab = images_[static_cast<std::size_t>(group.first + s)];
        job.from[s] = block.x_major ? slab.at(p0, q0 + r) : slab.at(q0 + r, p0);
      }
      any = kernels_.interleave(job) || any;
    }
    return any;
  }

  void mirror(const Group& group, int angle) const {
    for (int s = 0; s < group.slabs; ++s) {
      Slab& slab = sinograms_[static_cast<std::size_t>(group.first + s)];
      for (int c = 0; c < geometry_.columns; ++c) {
        std::copy_n(slab.at(c, angle), lanes, slab.at(geometry_.columns - 1 - c, angle + geometry_.angles / 2));
      }
    }
  }

  const ParallelGeometry& geometry_;
  std::span<const Slab> images_;
  std::span<Slab> sinograms_;
  Plan plan_;
  std::vector<Group> groups_;
  const RadonKernels& kernels_;
  std::vector<Block> blocks_;
};

}  // namespace

void forward(const ParallelGeometry& geometry, std::span<const Slab> images, std::span<Slab> sinograms, Simd level) {
  Forward(geometry, images, sinograms, level).run();
}

}  // namespace vam::tomo

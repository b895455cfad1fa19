#include "light/vial_operator.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/per_slice.hpp"
#include "base/simd.hpp"
#include "light/preconditioner.hpp"

namespace vam::light {

struct VialOperator::Kernels {
  decltype(&baseline::vial_gather) gather;
  decltype(&baseline::vial_scatter) scatter;
  decltype(&baseline::vial_blend) blend;
  decltype(&baseline::vial_spread) spread;

  static const Kernels& best() {
    static const Kernels plain{baseline::vial_gather, baseline::vial_scatter, baseline::vial_blend,
                               baseline::vial_spread};
#if defined(__x86_64__)
    static const Kernels wide{avx512::vial_gather, avx512::vial_scatter, avx512::vial_blend, avx512::vial_spread};
    static const Kernels middle{avx2::vial_gather, avx2::vial_scatter, avx2::vial_blend, avx2::vial_spread};
    if (simd_level() == Simd::avx512) return wide;
    if (simd_level() == Simd::avx2) return middle;
#endif
    return plain;
  }
};

/// Slabs that share the rays' weights.
struct VialOperator::Group {
  std::size_t first;
  std::size_t slabs;
  [[nodiscard]] int width() const { return static_cast<int>(slabs) * lanes; }
};

namespace {

constexpr int tile_edge = 8;  // voxels: their light of 32 angles fits into L2
constexpr int tile_voxels = tile_edge * tile_edge;
constexpr int widest = 4 * lanes;
constexpr double faint = 0.1;  // of the best column's: grazing rays are not amplified beyond

struct Tile {
  int i0, i1, j0, j1;
  Tile(Shape object, int tile) {
    const int across = (object.width + tile_edge - 1) / tile_edge;
    i0 = tile % across * tile_edge;
    j0 = tile / across * tile_edge;
    i1 = std::min(i0 + tile_edge, object.width);
    j1 = std::min(j0 + tile_edge, object.height);
  }
  static int count(Shape object) {
    return (object.width + tile_edge - 1) / tile_edge * ((object.height + tile_edge - 1) / tile_edge);
  }
};

int blocks_of(int rows) { return (rows + vial_rows - 1) / vial_rows; }

/// The preconditioner of parallel light that has as many columns and rows.
tomo::FilterSpec spec_of(const VialRays& rays) {
  tomo::ParallelGeometry rows;
  rows.columns = rays.columns();
  rows.angle_step_rad = std::abs(rays.setup().turn.step_rad);
  return preconditioner_spec(rows);
}

}  // namespace

VialOperator::VialOperator(const VialSetup& setup, std::span<const Slab> inserts)
    : rays_(setup),
      shadows_(rays_, inserts),
      kernels_(Kernels::best()),
      ramp_(rays_.columns(), {}),
      preconditioner_(rays_.columns(), spec_of(rays_)) {}

/// 4, 2 or 1 at a time; shadows differ from slice to slice.
std::vector<VialOperator::Group> VialOperator::groups(std::size_t slabs) const {
  std::vector<Group> all;
  for (std::size_t first = 0; first < slabs; first += all.back().slabs) {
    const std::size_t left = shadows_.empty() ? slabs - first : 1;
    all.push_back({first, left >= 4 ? 4U : left >= 2 ? 2U : 1U});
  }
  return all;
}

double VialOperator::row_angle_rad() const { return std::abs(rays_.setup().turn.step_rad); }

/// One stage angle, slabs side by side, every column smoothed by the shadow of a voxel.
void VialOperator::light_up(const Group& group, int row, std::span<const Slab> sinograms, float* light) const {
  std::fill_n(light, static_cast<std::ptrdiff_t>(rays_.row_stride()) * group.width(), 0.0F);
  for (int c = 0; c < rays_.columns(); ++c) {
    const VialRays::Shadow& shadow = rays_.shadow(c);
    float* to = light + static_cast<std::ptrdiff_t>(c + VialRays::padding) * group.width();
    for (std::size_t s = 0; s < group.slabs; ++s) {
      kernels_.blend(sinograms[group.first + s].at(shadow.first, row), lanes, shadow.weights.data(),
                     static_cast<int>(shadow.weights.size()), to + s * lanes);
    }
  }
}

/// The transpose of light_up.
void VialOperator::take_back(const Group& group, int row, const float* light, std::span<Slab> sinograms) const {
  for (std::size_t s = 0; s < group.slabs; ++s) {
    Slab& slab = sinograms[group.first + s];
    std::fill_n(slab.at(0, row), static_cast<std::ptrdiff_t>(rays_.columns()) * lanes, 0.0F);
    for (int c = 0; c < rays_.columns(); ++c) {
      const VialRays::Shadow& shadow = rays_.shadow(c);
      kernels_.spread(light + static_cast<std::ptrdiff_t>(c + VialRays::padding) * group.width() + s * lanes,
                      shadow.weights.data(), static_cast<int>(shadow.weights.size()), lanes,
                      slab.at(shadow.first, row));
    }
  }
}

/// Adds the light of a tile's voxels to the rows [row, row + rows).
void VialOperator::give_tile(const Group& group, int tile, std::span<const Slab> objects, int row, int rows,
                             float* light) const {
  const Tile at(object(), tile);
  alignas(64) float value[widest];
  VialRays::Voxel voxel{};
  VialTaps taps;
  for (int j = at.j0; j < at.j1; ++j) {
    for (int i = at.i0; i < at.i1; ++i) {
      for (std::size_t s = 0; s < group.slabs; ++s)
        std::copy_n(objects[group.first + s].at(i, j), lanes, value + s * lanes);
      if (std::all_of(value, value + group.width(), [](float v) { return v == 0; })) continue;
      if (!rays_.find(i, j, voxel)) continue;
      rays_.taps(voxel, row, rows, taps);
      if (shadows_.empty()) {
        kernels_.scatter(value, group.width(), taps, rows, light);
      } else {
        shadows_.scatter(group.first, i, j, row, rows, taps, value, light);
      }
    }
  }
}

void VialOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  const int all = sinogram().height;
  const int tiles = Tile::count(object());
  for (const Group& group : groups(objects.size())) {
    const std::ptrdiff_t row_size = static_cast<std::ptrdiff_t>(rays_.row_stride()) * group.width();
    parallel_for(blocks_of(all), [&](int block) {
      const int row = block * vial_rows;
      const int rows = std::min(vial_rows, all - row);
      std::vector<float, CacheAligned<float>> light(static_cast<std::size_t>(row_size) * vial_rows, 0.0F);
      for (int tile = 0; tile < tiles; ++tile) give_tile(group, tile, objects, row, rows, light.data());
      for (int r = 0; r < rows; ++r) take_back(group, row + r, light.data() + r * row_size, sinograms);
    });
  }
}

/// The dose of a tile's voxels: angles outside, voxels inside, so that the light of a few angles stays in the cache.
void VialOperator::take_tile(const Group& group, int tile, const float* light, std::span<Slab> objects) const {
  const Tile at(object(), tile);
  alignas(64) float sums[tile_voxels * widest] = {};
  VialRays::Voxel voxels[tile_voxels];
  bool lit[tile_voxels] = {};
  const auto index = [&](int i, int j) { return (j - at.j0) * tile_edge + i - at.i0; };
  for (int j = at.j0; j < at.j1; ++j) {
    for (int i = at.i0; i < at.i1; ++i) lit[index(i, j)] = rays_.find(i, j, voxels[index(i, j)]);
  }
  VialTaps taps;
  for (int row = 0; row < sinogram().height; row += vial_rows) {
    const int rows = std::min(vial_rows, sinogram().height - row);
    const float* from = light + static_cast<std::ptrdiff_t>(row) * rays_.row_stride() * group.width();
    for (int v = 0; v < tile_voxels; ++v) {
      if (!lit[v]) continue;
      float* sum = sums + static_cast<std::ptrdiff_t>(v) * group.width();
      rays_.taps(voxels[v], row, rows, taps);
      if (shadows_.empty()) {
        kernels_.gather(from, group.width(), taps, rows, sum);
      } else {
        shadows_.gather(group.first, at.i0 + v % tile_edge, at.j0 + v / tile_edge, row, rows, taps, from, sum);
      }
    }
  }
  for (int j = at.j0; j < at.j1; ++j) {
    for (int i = at.i0; i < at.i1; ++i) {
      const float* sum = sums + static_cast<std::ptrdiff_t>(index(i, j)) * group.width();
      for (std::size_t s = 0; s < group.slabs; ++s)
        std::copy_n(sum + s * lanes, lanes, objects[group.first + s].at(i, j));
    }
  }
}

void VialOperator::adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const {
  const int all = sinogram().height;
  for (const Group& group : groups(objects.size())) {
    const std::ptrdiff_t row_size = static_cast<std::ptrdiff_t>(rays_.row_stride()) * group.width();
    std::vector<float, CacheAligned<float>> light(static_cast<std::size_t>(row_size) * static_cast<std::size_t>(all));
    parallel_for(all, [&](int row) { light_up(group, row, sinograms, light.data() + row * row_size); });
    parallel_for(Tile::count(object()), [&](int tile) { take_tile(group, tile, light.data(), objects); });
  }
}

/// A f is about w (pitch / voxel) P f along a row, P the line integrals in voxels and w = T e^{-mu depth}; filtered
/// back-projection over a full turn is f = (1/2) integral of ramp P f over theta [KS88 eq 36], and a ramp across
/// columns is voxel / (J pitch) times one across voxels, which cancels the J of J / T [physics section 3]: (A A*)^-1 is
/// about (1/2) step (voxel / pitch)^2 w^-1 ramp w^-1.
void VialOperator::apply(const tomo::Filter& filter, std::span<Slab> sinograms) const {
  double most = 0;
  for (int c = 0; c < rays_.columns(); ++c) most = std::max(most, rays_.transmitted(c));
  std::vector<float> amplified;
  for (int c = 0; c < rays_.columns(); ++c) {
    amplified.push_back(static_cast<float>(1 / std::max(rays_.transmitted(c), faint * most)));
  }
  const double pitches = rays_.setup().grid.voxel_mm / rays_.setup().projector.pixel_mm;
  const auto amplify = [&](double gain) {
    for_values(sinograms, [&](std::size_t s, std::size_t first, std::size_t last) {
      float* row = sinograms[s].values.data() + first;
      for (std::size_t i = 0; i < last - first; ++i) row[i] *= amplified[i / lanes] * static_cast<float>(gain);
    });
  };
  amplify(1);
  for (Slab& slab : sinograms) filter.apply(slab);
  amplify(0.5 * row_angle_rad() * pitches * pitches);
}

void VialOperator::filter(std::span<Slab> sinograms) const { apply(ramp_, sinograms); }

void VialOperator::precondition(std::span<Slab> sinograms) const { apply(preconditioner_, sinograms); }

void VialOperator::expand(const Slab& sinogram, Slab& image) const {
  std::fill(image.values.begin(), image.values.end(), 0.0F);
  const auto fluence = static_cast<float>(1.0 / row_angle_rad());
  const auto count = static_cast<std::ptrdiff_t>(rays_.columns()) * lanes;
  parallel_for(image.height, [&](int a) {
    const float* from = sinogram.at(0, a);
    std::transform(from, from + count, image.at(rays_.first_column(), a), [&](float v) { return v * fluence; });
  });
}

void VialOperator::collapse(const Slab& image, Slab& sinogram) const {
  const auto dose = static_cast<float>(row_angle_rad());
  const auto count = static_cast<std::ptrdiff_t>(rays_.columns()) * lanes;
  parallel_for(image.height, [&](int a) {
    const float* from = image.at(rays_.first_column(), a);
    std::transform(from, from + count, sinogram.at(0, a), [&](float v) { return v * dose; });
  });
}

}  // namespace vam::light

#include "light/tile_light.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/simd.hpp"

namespace vam::light {

namespace {

struct Kernels {
  decltype(&baseline::range_of) range_of;
  decltype(&baseline::split_taps) split_taps;
  decltype(&baseline::take_rows) take_rows;
  decltype(&baseline::give_rows) give_rows;
  decltype(&baseline::gather_rays) gather;
  decltype(&baseline::scatter_rays) scatter;

  static const Kernels& best() {
    static const Kernels plain{baseline::range_of,  baseline::split_taps,  baseline::take_rows,
                               baseline::give_rows, baseline::gather_rays, baseline::scatter_rays};
#if defined(__x86_64__)
    static const Kernels wide{avx512::range_of,  avx512::split_taps,  avx512::take_rows,
                              avx512::give_rows, avx512::gather_rays, avx512::scatter_rays};
    static const Kernels middle{avx2::range_of,  avx2::split_taps,  avx2::take_rows,
                                avx2::give_rows, avx2::gather_rays, avx2::scatter_rays};
    if (simd_level() == Simd::avx512) return wide;
    if (simd_level() == Simd::avx2) return middle;
#endif
    return plain;
  }
};

/// Elements of a times b: sizes are multiplied as sizes.
std::size_t product(int a, int b) { return static_cast<std::size_t>(a) * static_cast<std::size_t>(b); }

constexpr int overrun = 32;  // floats that the row kernels may read and write beyond the last row: two vectors

int across(const model::Grid& grid, int edge) { return (grid.nx + edge - 1) / edge; }

}  // namespace

TileLight::TileLight(const VialRays& rays, const InsertShadow& shadow)
    : rays_(rays), shadow_(shadow), planes_(rays.climbs() ? 2 : 1), edge_(rays.tile()) {}

std::vector<std::vector<TileLight::Entry>> TileLight::tiles(const VialRays& rays) {
  const model::Grid& grid = rays.setup().grid;
  const int edge = rays.tile();
  std::vector<std::vector<Entry>> all(static_cast<std::size_t>(across(grid, edge) * ((grid.ny + edge - 1) / edge)));
  parallel_for(grid.ny, [&](int row) {
    if (row % edge != 0) return;
    TapSource found[VialRays::most_rays];
    for (int j = row; j < std::min(row + edge, grid.ny); ++j) {
      for (int i = 0; i < grid.nx; ++i) {
        const int count = rays.find(i, j, found);
        auto& tile = all[product(row / edge, across(grid, edge)) + static_cast<std::size_t>(i / edge)];
        for (int ray = 0; ray < count; ++ray) tile.push_back({found[ray], (j - row) * edge + i % edge});
      }
    }
  });
  return all;
}

void TileLight::enter(int tile, std::span<const Entry> entries, const Chunk& chunk) {
  const model::Grid& grid = rays_.setup().grid;
  const int edge = edge_;
  chunk_ = chunk;
  entries_ = entries;
  i0_ = tile % across(grid, edge) * edge;
  j0_ = tile / across(grid, edge) * edge;
  i1_ = std::min(i0_ + edge, grid.nx);
  j1_ = std::min(j0_ + edge, grid.ny);
  voxel_of_.clear();
  for (const Entry& entry : entries_) voxel_of_.push_back(entry.voxel);
  taps_.resize(entries_.size());
  split_.resize(entries_.size());
  at_.resize(tap_angles);
  const std::size_t block = static_cast<std::size_t>(rays_.taps()) * tap_angles;
  weights_.resize(3 * entries_.size() * block);
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    taps_[e].weight = weights_.data() + 3 * e * block;
    for (const std::size_t p : {0U, 1U}) split_[e].weight[p] = taps_[e].weight + (p + 1) * block;
  }
  voxels_.resize(product(edge_ * edge_, chunk.width()));
}

/// Slices from grid.nz on are no part of a volume whose rays climb.
template <class Row>
void TileLight::each_voxel(const Row& visit) const {
  const int slices = rays_.climbs() ? rays_.setup().grid.nz - chunk_.slice() : chunk_.width();
  for (int j = j0_; j < j1_; ++j) {
    for (int i = i0_; i < i1_; ++i) {
      for (std::size_t s = 0; s < chunk_.slabs; ++s) {
        const int used = std::clamp(slices - static_cast<int>(s) * lanes, 0, lanes);
        const auto at = product((j - j0_) * edge_ + i - i0_, chunk_.width()) + s * lanes;
        visit(i, j, chunk_.first + s, at, used);
      }
    }
  }
}

void TileLight::load_voxels(std::span<const Slab> objects) {
  clear_voxels();
  each_voxel([&](int i, int j, std::size_t slab, std::size_t at, int used) {
    std::copy_n(objects[slab].at(i, j), used, voxels_.data() + at);
  });
}

void TileLight::store_voxels(std::span<Slab> objects) const {
  each_voxel([&](int i, int j, std::size_t slab, std::size_t at, int used) {
    float* to = objects[slab].at(i, j);
    std::copy_n(voxels_.data() + at, used, to);
    std::fill(to + used, to + lanes, 0.0F);
  });
}

/// Taps of all entries, and the tile's columns and planes at each stage angle.
void TileLight::aim(const RayNodes& nodes, int angle, int count) {
  for (std::size_t e = 0; e < entries_.size(); ++e) rays_.taps(nodes, entries_[e].ray, angle, taps_[e]);
  const float half = 0.5F * static_cast<float>(chunk_.width() - 1);
  const float outer = rays_.rises(chunk_.slice(), chunk_.width()) ? half : -half;
  TapRange range;
  Kernels::best().range_of(taps_.data(), static_cast<int>(entries_.size()), outer, range);
  for (int a = 0; a < count; ++a) {
    Planes& planes = at_[static_cast<std::size_t>(a)];
    planes.column = range.first[a];
    planes.columns = range.last[a] - range.first[a] + rays_.taps();
    planes.zoom[0] = range.low_zoom[a];
    planes.zoom[1] = range.high_zoom[a];
    planes.row[0] = range.low_row[a] - half * range.low_zoom[a];
    planes.row[1] = range.high_row[a] - half * range.high_zoom[a];
  }
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    Kernels::best().split_taps(taps_[e], taps_[e].taps, planes_, outer, range, split_[e]);
  }
}

/// Rows [first, end) may be lit.
TileLight::Rows TileLight::lit_rows(std::size_t slabs) const {
  const int all = static_cast<int>(slabs) * lanes;
  if (!rays_.climbs()) return {0, all};
  return {rays_.first_row(), std::min(all, rays_.end_row())};
}

namespace {

/// Rows that a plane of a chunk reads: [first, last), from a slab's first row on.
struct Window {
  int first, last;
  /// What a line of them needs, with what the row kernels touch beyond.
  [[nodiscard]] std::size_t floats() const {
    return static_cast<std::size_t>(last) - static_cast<std::size_t>(first) + lanes + overrun;
  }
};

template <class Planes>
Window window_of(const Planes& planes, int width) {
  const float slices = static_cast<float>(width - 1);
  const float low = std::min(
      {planes.row[0], planes.row[1], planes.row[0] + slices * planes.zoom[0], planes.row[1] + slices * planes.zoom[1]});
  const float high = std::max(
      {planes.row[0], planes.row[1], planes.row[0] + slices * planes.zoom[0], planes.row[1] + slices * planes.zoom[1]});
  const int first = static_cast<int>(std::floor(low / lanes)) * lanes;
  return {first, static_cast<int>(std::floor(high)) + 2};
}

}  // namespace

void TileLight::fetch(const Planes& planes, int angle, std::span<const Slab> sinograms) {
  const int width = chunk_.width();
  const int padding = rays_.padding();
  light_.resize(product(planes.columns * planes_, width));
  const Window rows = window_of(planes, width);
  line_.assign(rows.floats(), 0.0F);
  const Rows lit = lit_rows(sinograms.size());
  for (int c = 0; c < planes.columns; ++c) {
    float* to = light_.data() + static_cast<std::ptrdiff_t>(c) * planes_ * width;
    const int column = planes.column + c - padding;
    if (column < 0 || column >= rays_.columns()) {
      std::fill_n(to, planes_ * width, 0.0F);
      continue;
    }
    if (planes_ == 1) {
      for (std::size_t s = 0; s < chunk_.slabs; ++s) {
        std::copy_n(sinograms[chunk_.first + s].at(column, angle), lanes, to + s * lanes);
      }
      continue;
    }
    for (int slab = std::max(rows.first, 0); slab < std::min(rows.last, lit.end); slab += lanes) {
      const float* from = sinograms[static_cast<std::size_t>(slab / lanes)].at(column, angle) - slab;
      const int first = std::max(slab, lit.first);
      std::copy_n(from + first, std::max(0, std::min(slab + lanes, lit.end) - first),
                  line_.data() + (first - rows.first));
    }
    for (const int p : {0, 1}) {
      Kernels::best().take_rows(line_.data(), planes.row[p] - static_cast<float>(rows.first), planes.zoom[p], width,
                                to + product(p, width));
    }
  }
}

void TileLight::put_back(const Planes& planes, int angle, std::span<Slab> sinograms) {
  const int width = chunk_.width();
  const int padding = rays_.padding();
  const Window rows = window_of(planes, width);
  const Rows lit = lit_rows(sinograms.size());
  for (int c = 0; c < planes.columns; ++c) {
    const float* from = light_.data() + static_cast<std::ptrdiff_t>(c) * planes_ * width;
    const int column = planes.column + c - padding;
    if (column < 0 || column >= rays_.columns()) continue;
    if (planes_ == 1) {
      for (std::size_t s = 0; s < chunk_.slabs; ++s) {
        float* to = sinograms[chunk_.first + s].at(column, angle);
        for (int lane = 0; lane < lanes; ++lane) to[lane] += from[s * lanes + static_cast<std::size_t>(lane)];
      }
      continue;
    }
    line_.assign(rows.floats(), 0.0F);
    for (const int p : {0, 1}) {
      Kernels::best().give_rows(from + product(p, width), planes.row[p] - static_cast<float>(rows.first),
                                planes.zoom[p], width, line_.data());
    }
    for (int slab = std::max(rows.first, 0); slab < std::min(rows.last, lit.end); slab += lanes) {
      float* to = sinograms[static_cast<std::size_t>(slab / lanes)].at(column, angle) - slab;
      const int first = std::max(slab, lit.first);
      const int count = std::max(0, std::min(slab + lanes, lit.end) - first);
      const float* line = line_.data() + (first - rows.first);
      for (int row = 0; row < count; ++row) to[first + row] += line[row];
    }
  }
}

void TileLight::take(const RayNodes& nodes, int angle, int count, std::span<const Slab> sinograms) {
  aim(nodes, angle, count);
  for (int a = 0; a < count; ++a) {
    if (shadowed(angle, a)) {
      take_shadowed(angle, a, sinograms);
      continue;
    }
    fetch(at_[static_cast<std::size_t>(a)], angle + a, sinograms);
    Kernels::best().gather(light_.data(), chunk_.width(), planes_, split_.data(), voxel_of_.data(),
                           static_cast<int>(entries_.size()), a, voxels_.data());
  }
}

void TileLight::give(const RayNodes& nodes, int angle, int count, std::span<Slab> sinograms) {
  aim(nodes, angle, count);
  for (int a = 0; a < count; ++a) {
    if (shadowed(angle, a)) {
      give_shadowed(angle, a, sinograms);
      continue;
    }
    const Planes& planes = at_[static_cast<std::size_t>(a)];
    light_.assign(product(planes.columns * planes_, chunk_.width()), 0.0F);
    Kernels::best().scatter(voxels_.data(), chunk_.width(), planes_, split_.data(), voxel_of_.data(),
                            static_cast<int>(entries_.size()), a, light_.data());
    put_back(planes, angle + a, sinograms);
  }
}

/// visit(voxel's value, slab, column, lane, weight) of every pixel that the insert leaves unhindered: what take and
/// give share around inserts. Slow and plain, as every pixel ends elsewhere.
template <class Visit>
void TileLight::each_shadowed(int angle, int index, std::size_t slabs, const Visit& visit) {
  const model::Grid& grid = rays_.setup().grid;
  const int width = chunk_.width();
  const Rows lit = lit_rows(slabs);
  const float half = 0.5F * static_cast<float>(width - 1);
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    const int voxel = entries_[e].voxel;
    const double x = grid.x_mm(i0_ + voxel % edge_);
    const int j = j0_ + voxel / edge_;
    const double y = grid.y_mm(j);
    const Taps& taps = taps_[e];
    for (int k = 0; k < taps.taps; ++k) {
      const int column = taps.cell[index] + k - rays_.padding();
      if (column < 0 || column >= rays_.columns() || taps.weight[k * tap_angles + index] == 0) continue;
      const float u = shadow_.depth_mm(x, y, angle + index, column);
      for (int l = 0; l < width; ++l) {
        const float place = planes_ == 1 ? static_cast<float>(chunk_.slice() + l)
                                         : taps.row[index] + taps.zoom[index] * (static_cast<float>(l) - half);
        const float below = std::floor(place);
        const float part = place - below;
        for (const int side : {0, 1}) {
          const int row = static_cast<int>(below) + side;
          const float weight = taps.weight[k * tap_angles + index] * (side == 0 ? 1 - part : part);
          if (row < lit.first || row >= lit.end || weight == 0) continue;
          const auto slab = static_cast<std::size_t>(row / lanes);
          if (u < shadow_.ends_mm(slab, column, angle + index)[row % lanes]) {
            visit(voxels_[product(voxel, width) + static_cast<std::size_t>(l)], slab, column, row % lanes, weight);
          }
        }
      }
    }
  }
}

/// Whether the insert ends any of the rays that light the tile.
bool TileLight::shadowed(int angle, int index) const {
  if (shadow_.empty()) return false;
  const Planes& planes = at_[static_cast<std::size_t>(index)];
  for (int c = 0; c < planes.columns; ++c) {
    const int column = planes.column + c - rays_.padding();
    if (column >= 0 && column < rays_.columns() && shadow_.hinders(column, angle + index)) return true;
  }
  return false;
}

void TileLight::take_shadowed(int angle, int index, std::span<const Slab> sinograms) {
  each_shadowed(angle, index, sinograms.size(),
                [&](float& voxel, std::size_t slab, int column, int lane, float weight) {
                  voxel += weight * sinograms[slab].at(column, angle + index)[lane];
                });
}

void TileLight::give_shadowed(int angle, int index, std::span<Slab> sinograms) {
  each_shadowed(angle, index, sinograms.size(),
                [&](const float& voxel, std::size_t slab, int column, int lane, float weight) {
                  sinograms[slab].at(column, angle + index)[lane] += weight * voxel;
                });
}

}  // namespace vam::light

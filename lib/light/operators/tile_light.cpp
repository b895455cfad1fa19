#include "light/operators/private/tile_light.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "base/simd.hpp"
#include "light/operators/private/columns_kernel.hpp"

namespace vam::light {

namespace {

struct TileKernels {
  decltype(&baseline::gather_rays) gather;
  decltype(&baseline::scatter_rays) scatter;
  decltype(&baseline::copy_columns) copy;
  decltype(&baseline::add_columns) add;

  static const TileKernels& best() {
    const Simd level = simd_level();
    static const TileKernels kernels{VAM_KERNEL(gather_rays, level), VAM_KERNEL(scatter_rays, level),
                                     VAM_KERNEL(copy_columns, level), VAM_KERNEL(add_columns, level)};
    return kernels;
  }
};

constexpr int overrun = 32;  // floats that the kernels may read and write beyond: two vectors

void fill_last_block(Tile& tile) {
  while (tile.rays.size() % ray_block != 0) tile.rays.push_back(tile.rays.back());
}

int tiles_across(int voxels) { return (voxels + TileLight::edge - 1) / TileLight::edge; }

}  // namespace

TileLight::TileLight(const VialRays& rays, const InsertShadow& shadow) : rays_(rays), shadow_(shadow) {}

std::vector<Tile> TileLight::tiles(const VialRays& rays) {
  const model::Grid& grid = rays.setup().grid;
  const int across = tiles_across(grid.nx);
  std::vector<Tile> all(product(across, tiles_across(grid.ny)));
  parallel_for(count_of(all), [&](int t) {
    Tile& tile = all[t];
    RaySource found[VialRays::most_rays];
    double r_mm = 0;
    for (int voxel = 0; voxel < edge * edge; ++voxel) {
      const int i = t % across * edge + voxel % edge;
      const int j = t / across * edge + voxel / edge;
      if (i >= grid.nx || j >= grid.ny) continue;
      r_mm = std::max(r_mm, std::hypot(grid.x_mm(i), grid.y_mm(j)));
      if (rays.posed()) {
        if (std::hypot(grid.x_mm(i), grid.y_mm(j)) <= rays.setup().radius_mm) tile.voxels.push_back(voxel);
        continue;
      }
      const int count = rays.find(i, j, found);
      tile.rays.insert(tile.rays.end(), found, found + count);
      tile.voxels.insert(tile.voxels.end(), count, voxel);
    }
    tile.chunk = rays.chunk(r_mm);
    fill_last_block(tile);
  });
  return all;
}

void TileLight::enter(int tile, const Tile& rays, const Chunk& chunk) {
  const model::Grid& grid = rays_.setup().grid;
  const int across = tiles_across(grid.nx);
  chunk_ = chunk;
  tile_ = &rays;
  i0_ = tile % across * edge;
  j0_ = tile / across * edge;
  i1_ = std::min(i0_ + edge, grid.nx);
  j1_ = std::min(j0_ + edge, grid.ny);
  make_room(rays.rays.size());
  voxels_.resize(voxel_gap + product(product(edge, edge), chunk.width() + voxel_gap) + overrun);
}

void TileLight::make_room(std::size_t pitch) {
  cells_.resize(pitch);
  floats_.resize((2 + rays_.taps()) * pitch);
  taps_ = {cells_.data(),
           floats_.data(),
           floats_.data() + pitch,
           floats_.data() + 2 * pitch,
           static_cast<int>(pitch),
           0,
           0,
           0,
           0,
           0};
}

/// Slices from grid.nz on are no part of a volume whose rays climb.
template <class Visit>
void TileLight::each_voxel(const Visit& visit) const {
  const int slices = rays_.climbs() ? rays_.setup().grid.nz - chunk_.slice() : chunk_.width();
  for (int j = j0_; j < j1_; ++j) {
    for (int i = i0_; i < i1_; ++i) {
      for (std::size_t s = 0; s < chunk_.slabs; ++s) {
        const int used = std::clamp(slices - static_cast<int>(s) * lanes, 0, lanes);
        const auto at = voxel_gap + product((j - j0_) * edge + i - i0_, chunk_.width() + voxel_gap) + s * lanes;
        visit(i, j, chunk_.first + s, at, used);
      }
    }
  }
}

void TileLight::load_voxels(const Window<const Slab>& objects) {
  clear_voxels();
  each_voxel([&](int i, int j, std::size_t slab, std::size_t at, int used) {
    std::copy_n(objects[slab].at(i, j), used, voxels_.data() + at);
  });
}

void TileLight::load_bright_voxels(const Window<const Slab>& objects) {
  load_voxels(objects);
  keep_bright();
}

void TileLight::keep_bright() {
  const Tile& all = *tile_;
  bool bright[edge * edge];
  for (int voxel = 0; voxel < edge * edge; ++voxel) {
    const float* slices = voxels_.data() + voxel_gap + product(voxel, chunk_.width() + voxel_gap);
    bright[voxel] = std::any_of(slices, slices + chunk_.width(), [](float v) { return v != 0.0F; });
  }
  bright_.rays.clear();
  bright_.voxels.clear();
  for (std::size_t e = 0; e < all.voxels.size(); ++e) {
    if (!bright[all.voxels[e]]) continue;
    bright_.voxels.push_back(all.voxels[e]);
    if (!all.rays.empty()) bright_.rays.push_back(all.rays[e]);
  }
  fill_last_block(bright_);
  tile_ = &bright_;
  make_room(bright_.rays.size());
}

void TileLight::store_voxels(const Window<Slab>& objects) const {
  each_voxel([&](int i, int j, std::size_t slab, std::size_t at, int used) {
    float* to = objects[slab].at(i, j);
    std::copy_n(voxels_.data() + at, used, to);
    std::fill(to + used, to + lanes, 0.0F);
  });
}

/// Every voxel stands elsewhere than a frame before.
bool TileLight::find_posed_taps(int frame) {
  posed_voxels_.clear();
  if (!rays_.lit(chunk_.slice(), chunk_.width(), frame)) return false;
  const HeightScale scale = rays_.posed_scale(chunk_.slice(), chunk_.width(), frame);
  posed_nodes_.resize(tile_->voxels.size() * VialRays::most_rays + 1);
  int rays = 0;
  for (const int voxel : tile_->voxels) {
    const int found = rays_.find_posed(i0_ + voxel % edge, j0_ + voxel / edge, frame, scale, &posed_nodes_[rays]);
    posed_voxels_.insert(posed_voxels_.end(), found, voxel);
    rays += found;
  }
  if (rays == 0) return false;
  const int whole = (rays + ray_block - 1) / ray_block * ray_block;
  posed_nodes_.resize(static_cast<std::size_t>(whole) + 1);
  std::fill(posed_nodes_.begin() + rays, posed_nodes_.end(), posed_nodes_[rays - 1]);
  make_room(whole);
  rays_.find_posed_taps(posed_nodes_, rays, frame, chunk_.width(), taps_);
  return true;
}

/// The taps of all rays, and the columns and rows that they take from.
bool TileLight::find_taps(const RayNodes& nodes, int angle, const SlabRange& rows) {
  if (rays_.posed()) {
    if (!find_posed_taps(angle)) return false;
  } else {
    rays_.find_taps(nodes, tile_->rays.data(), count(), angle, chunk_.width(), taps_);
  }
  columns_ = taps_.last_cell - taps_.first_cell + taps_.taps;
  if (!rays_.climbs()) {
    row_ = chunk_.slice();
    rows_ = chunk_.width();
    lit_first_ = static_cast<int>(rows.first) * lanes;
    lit_end_ = static_cast<int>(rows.end) * lanes;
    return true;
  }
  taps_.first_row = std::floor(taps_.first_row);
  row_ = static_cast<int>(taps_.first_row);
  const int needed = static_cast<int>(taps_.last_row - taps_.first_row) + 2;
  rows_ = (needed + lanes - 1) / lanes * lanes;
  lit_first_ = std::max(static_cast<int>(rows.first) * lanes, rays_.first_row());
  lit_end_ = std::min(static_cast<int>(rows.end) * lanes, rays_.end_row());
  return true;
}

/// visit(slab's pixel, place in the tile's light, columns, rows): the lit pixels of the tile, slab by slab.
template <class SlabType, class Visit>
void TileLight::each_piece(int angle, const Window<SlabType>& sinograms, const Visit& visit) const {
  const int dark = std::max(0, rays_.padding() - taps_.first_cell);  // columns before the first
  const int column = taps_.first_cell + dark - rays_.padding();
  const int count = std::min(columns_ - dark, rays_.columns() - column);
  if (count <= 0) return;
  const int first = std::max(row_, lit_first_);
  const int end = std::min(row_ + rows_, lit_end_);
  for (int row = first; row < end;) {
    const int next = std::min(end, (row / lanes + 1) * lanes);
    visit(sinograms[row / lanes].at(column, angle) + row % lanes, product(dark, rows_) + row - row_, count, next - row);
    row = next;
  }
}

void TileLight::fetch(int angle, const Window<const Slab>& sinograms) {
  light_.assign(product(columns_, rows_), 0.0F);
  const auto next = static_cast<std::ptrdiff_t>(product(rays_.columns(), lanes));  // the next stage angle
  each_piece(angle, sinograms, [&](const float* from, std::size_t at, int columns, int rows) {
    TileKernels::best().copy(from, columns, rows, rows_, next, light_.data() + at);
  });
}

void TileLight::put_back(int angle, const Window<Slab>& sinograms) const {
  const auto next = static_cast<std::ptrdiff_t>(product(rays_.columns(), lanes));
  each_piece(angle, sinograms, [&](float* to, std::size_t at, int columns, int rows) {
    TileKernels::best().add(light_.data() + at, columns, rows, rows_, next, to);
  });
}

/// Whether the insert ends any of the rays that light the tile.
bool TileLight::shadowed(int angle) const {
  if (shadow_.empty()) return false;
  for (int c = 0; c < columns_; ++c) {
    const int column = taps_.first_cell + c - rays_.padding();
    if (column >= 0 && column < rays_.columns() && shadow_.occludes(column, angle)) return true;
  }
  return false;
}

/// How far the light of the tile's pixels reaches, and how far in the voxels are on the rays of their columns.
void TileLight::cast_shadow(int angle) {
  ends_.assign(product(columns_, rows_), InsertShadow::unhindered);
  each_piece(angle, Window<const Slab>{0, shadow_.ends()},
             [&](const float* from, std::size_t at, int columns, int rows) {
               TileKernels::best().copy(from, columns, rows, rows_, 0, ends_.data() + at);
             });
  const model::Grid& grid = rays_.setup().grid;
  depth_.assign(product(taps_.taps, taps_.pitch), 0.0F);
  for (int e = 0; e < count(); ++e) {
    const int voxel = voxels()[e];
    const int j = j0_ + voxel / edge;
    const double x = grid.x_mm(i0_ + voxel % edge);
    const double y = grid.y_mm(j);
    for (int k = 0; k < taps_.taps; ++k) {
      const int column = std::clamp(taps_.cell[e] + k - rays_.padding(), 0, rays_.columns() - 1);
      depth_[product(k, taps_.pitch) + e] = shadow_.depth_mm(x, y, angle, column);
    }
  }
}

TileColumns TileLight::columns() {
  return {light_.data(), ends_.empty() ? nullptr : ends_.data(), depth_.data(), rows_};
}

void TileLight::take(const RayNodes& nodes, int angle, const Window<const Slab>& sinograms) {
  if (!find_taps(nodes, angle, {sinograms.first, sinograms.end()})) return;
  fetch(angle, sinograms);
  ends_.clear();
  if (shadowed(angle)) cast_shadow(angle);
  TileKernels::best().gather(columns(), taps_, voxels().data(), count(), chunk_.width(), rays_.climbs(),
                             voxels_.data() + voxel_gap);
}

void TileLight::give(const RayNodes& nodes, int angle, const Window<Slab>& sinograms) {
  if (tile_->voxels.empty()) return;
  if (!find_taps(nodes, angle, {sinograms.first, sinograms.end()})) return;
  light_.assign(product(columns_, rows_), 0.0F);
  ends_.clear();
  if (shadowed(angle)) cast_shadow(angle);
  TileKernels::best().scatter(voxels_.data() + voxel_gap, taps_, voxels().data(), count(), chunk_.width(),
                              rays_.climbs(), columns());
  put_back(angle, sinograms);
}

}  // namespace vam::light

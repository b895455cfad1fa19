// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/tile_light.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "base/compute/simd.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "light/operators/private/columns_kernel.hpp"

namespace vam::light {

namespace {

struct TileKernels {
  decltype(&baseline::gather_rays) gather;
  decltype(&baseline::scatter_rays) scatter;
  decltype(&baseline::copy_columns) copy;
  decltype(&baseline::add_columns) add;
  decltype(&baseline::spread_rows) spread;

  static const TileKernels& best() {
    const Simd level = simd_level();
    static const TileKernels kernels{VAM_KERNEL(gather_rays, level), VAM_KERNEL(scatter_rays, level),
                                     VAM_KERNEL(copy_columns, level), VAM_KERNEL(add_columns, level),
                                     VAM_KERNEL(spread_rows, level)};
    return kernels;
  }
};

constexpr int overrun = 32;  // floats that the kernels may read and write beyond: two vectors

/// A constant length is copied without a call.
void copy_lanes(const float* from, int used, float* to) {
  if (used == lanes) {
    std::memcpy(to, from, lanes * sizeof(float));
  } else {
    for (int i = 0; i < used; ++i) to[i] = from[i];
  }
}

}  // namespace

TileLight::TileLight(const VialRays& rays, const InsertShadow& shadow, const Tile& tile, const Chunk& chunk,
                     const SlabRange& rows)
    : rays_(rays),
      shadow_(shadow),
      tile_(tile),
      chunk_(chunk),
      lit_first_(static_cast<int>(rows.first) * lanes),
      lit_end_(static_cast<int>(rows.end) * lanes) {
  voxels_.resize(voxel_at(count_of(tile.voxels)) + overrun);
  if (!rays.climbs()) return;
  lit_first_ = std::max(lit_first_, rays.first_row());
  lit_end_ = std::min(lit_end_, rays.end_row());
}

std::size_t TileLight::voxel_at(int voxel) const {
  const int gap = voxel_gap(rays_.climbs());
  return gap + product(voxel, chunk_.width() + gap);
}

/// Slices from grid.nz on are no part of a volume whose rays climb.
template <class Visit>
void TileLight::each_voxel(const Visit& visit) const {
  const model::Grid& grid = rays_.setup().grid;
  const int slices = rays_.climbs() ? grid.nz - chunk_.slice() : chunk_.width();
  for (int voxel = 0; voxel < count_of(tile_.voxels); ++voxel) {
    const VoxelColumn column = tile_.voxels[voxel].turned(quarters_, grid.nx);
    const std::size_t at = voxel_at(voxel);
    for (std::size_t s = 0; s < chunk_.slabs; ++s) {
      const int used = std::clamp(slices - static_cast<int>(s) * lanes, 0, lanes);
      visit(column, chunk_.first + s, at + s * lanes, used);
    }
  }
}

void TileLight::load_voxels(const Window<const Slab>& objects) {
  std::fill(voxels_.begin(), voxels_.end(), 0.0F);
  each_voxel([&](const VoxelColumn& column, std::size_t slab, std::size_t at, int used) {
    copy_lanes(objects[slab].at(column.i, column.j), used, voxels_.data() + at);
  });
  voxel_rays_ = tile_.voxel_rays;
  bright_only_ = false;
}

bool TileLight::bright(int voxel) const {
  const float* slices = voxels_.data() + voxel_at(voxel);
  return std::any_of(slices, slices + chunk_.width(), [](float v) { return v != 0.0F; });
}

bool TileLight::load_bright_voxels(const Window<const Slab>& objects) {
  load_voxels(objects);
  bright_only_ = true;
  if (rays_.posed()) {
    for (int voxel = 0; voxel < count_of(tile_.voxels); ++voxel) {
      if (bright(voxel)) return true;
    }
    return false;
  }
  std::erase_if(voxel_rays_, [&](const VoxelRay& ray) { return !bright(ray.voxel); });
  return !voxel_rays_.empty();
}

void TileLight::store_voxels(const Window<Slab>& objects) const {
  each_voxel([&](const VoxelColumn& column, std::size_t slab, std::size_t at, int used) {
    float* to = objects[slab].at(column.i, column.j);
    copy_lanes(voxels_.data() + at, used, to);
    std::fill(to + used, to + lanes, 0.0F);
  });
}

void AngleTaps::make_room(std::size_t rays, int most_taps) {
  cells.resize(rays);
  floats.resize((2 + most_taps) * rays);
  taps = {};
  taps.cell = cells.data();
  taps.start = floats.data();
  taps.zoom = floats.data() + rays;
  taps.weight = floats.data() + 2 * rays;
  taps.pitch = static_cast<int>(rays);
}

/// Every voxel stands elsewhere than a frame before.
void TileLight::find_posed(AngleTaps& to) {
  const int frame = to.angle;
  if (!rays_.lit(chunk_.slice(), chunk_.width(), frame)) return;
  const HeightScale scale = rays_.posed_scale(chunk_.slice(), chunk_.width(), frame);
  posed_nodes_.resize(tile_.voxels.size() * VialRays::most_rays + 1);
  int rays = 0;
  for (int voxel = 0; voxel < count_of(tile_.voxels); ++voxel) {
    if (bright_only_ && !bright(voxel) && rays_.spread().most() == 0) continue;
    const VoxelColumn& column = tile_.voxels[voxel];
    const int found = rays_.find_posed(column.i, column.j, frame, scale, &posed_nodes_[rays]);
    for (int k = 0; k < found; ++k) to.posed.push_back({rays + k, voxel});
    rays += found;
  }
  if (rays == 0) return;
  const int whole = (rays + ray_block - 1) / ray_block * ray_block;
  posed_nodes_.resize(static_cast<std::size_t>(whole) + 1);
  std::fill(posed_nodes_.begin() + rays, posed_nodes_.end(), posed_nodes_[rays - 1]);
  to.make_room(whole, rays_.taps());
  rays_.find_posed_taps(posed_nodes_, rays, frame, chunk_.width(), to.taps);
}

/// The taps of all rays, and the columns and rows that they take from.
void TileLight::find_angle(const RayNodes& nodes, AngleTaps& to) {
  if (rays_.posed()) {
    find_posed(to);
    if (to.posed.empty()) return;
  } else {
    to.make_room(tile_.rays.size(), rays_.taps());
    rays_.find_taps(nodes, tile_.rays.data(), count_of(tile_.rays), to.angle, chunk_.width(), to.taps);
  }
  to.lit = true;
  to.columns = to.taps.last_cell - to.taps.first_cell + to.taps.taps;
  to.row = chunk_.slice();
  to.rows = to.used = chunk_.width();
  if (!rays_.climbs()) return;
  to.spread = spread_of(to);
  const int spread = rays_.spread().half_width(to.spread);
  const double across = static_cast<double>(to.taps.last_row) - to.taps.first_row + 2 * spread;
  if (!(across < most_tile_rows - 2 - (spread > 0 ? lanes : 0))) {  // VialRays bounds the slopes
    throw Error{Fault::data,
                "projector: " + format_number(across, 3) + " rows of its images cross " +
                    std::to_string(chunk_.width()) + " slices, and " + std::to_string(most_tile_rows) + " can; " +
                    (4 * spread > across ? "their light spreads too far (projector.half_angle_deg, projector.focus_mm)"
                                         : "the slices are too far from the height of the lens (projector.axis_row)")};
  }
  to.taps.first_row = std::floor(to.taps.first_row);
  to.first = spread;
  to.row = static_cast<int>(to.taps.first_row) - spread;
  const auto whole = [](int rows) { return (rows + lanes - 1) / lanes * lanes; };
  to.used = whole(static_cast<int>(to.taps.last_row - to.taps.first_row) + 2);
  to.rows = whole(to.used + 2 * spread);
}

TileTaps TileLight::find_taps(const RayNodes& nodes, int first, int end) {
  const int quarters = rays_.quarters();
  TileTaps all;
  all.reserve(product(quarters, end - first));
  for (int quarter = 0; quarter < quarters; ++quarter) {
    for (int angle = first; angle < end; ++angle) {
      all.emplace_back().angle = angle + quarter * (rays_.setup().turn.rows / quarters);
      find_angle(nodes, all.back());
    }
  }
  return all;
}

/// visit(slab's pixel, place in the tile's light, columns, rows): the lit pixels of the tile, slab by slab.
template <class SlabType, class Visit>
void TileLight::each_piece(const AngleTaps& from, int angle, const Window<SlabType>& sinograms,
                           const Visit& visit) const {
  const int dark = std::max(0, rays_.padding() - from.taps.first_cell);  // columns before the first
  const int column = from.taps.first_cell + dark - rays_.padding();
  const int count = std::min(from.columns - dark, rays_.columns() - column);
  if (count <= 0) return;
  const int first = std::max(from.row, lit_first_);
  const int end = std::min(from.row + from.rows, lit_end_);
  for (int row = first; row < end;) {
    const int next = std::min(end, (row / lanes + 1) * lanes);
    visit(sinograms[row / lanes].at(column, angle) + row % lanes, product(dark, from.rows) + row - from.row, count,
          next - row);
    row = next;
  }
}

void TileLight::fetch(const AngleTaps& from, int angle, const Window<const Slab>& sinograms) {
  light_.assign(product(from.columns, from.rows) + product(2, most_spread_rows), 0.0F);
  const auto next = static_cast<std::ptrdiff_t>(product(rays_.columns(), lanes));  // the next stage angle
  each_piece(from, angle, sinograms, [&](const float* light, std::size_t at, int columns, int rows) {
    TileKernels::best().copy(light, columns, rows, from.rows, next, light_.data() + most_spread_rows + at);
  });
}

/// By how much the light of the tile's middle spreads, and how far between rows it is read; whatever voxels are dark.
int TileLight::spread_of(const AngleTaps& at) const {
  if (rays_.spread().most() == 0) return 0;
  constexpr int samples = 16;
  const std::vector<VoxelRay>& all = rays_.posed() ? at.posed : tile_.voxel_rays;
  const int ray = all[all.size() / 2].ray;
  double read = 0;
  for (int i = 0; i < samples; ++i) {
    const double row = static_cast<double>(at.taps.start[ray] + at.taps.zoom[ray] * static_cast<float>(i));
    const double place = row - std::floor(row);
    read += place * (1 - place) / samples;
  }
  const VoxelColumn& middle = tile_.voxels[tile_.voxels.size() / 2];
  return rays_.spread().step(rays_.spread_rows(middle.i, middle.j, at.angle), read);
}

void TileLight::spread(const AngleTaps& over, const Light& from, Light& to) const {
  const std::span<const float> weights = rays_.spread().weights(over.spread);
  to.resize(from.size());
  TileKernels::best().spread(weights.data(), count_of(weights) - 1, over.columns * over.rows,
                             from.data() + most_spread_rows, to.data() + most_spread_rows);
}

void TileLight::put_back(const AngleTaps& to, int angle, const Window<Slab>& sinograms) {
  if (to.spread > 0) spread(to, light_, spread_);
  const float* from = (to.spread > 0 ? spread_ : light_).data() + most_spread_rows;
  const auto next = static_cast<std::ptrdiff_t>(product(rays_.columns(), lanes));
  each_piece(to, angle, sinograms, [&](float* light, std::size_t at, int columns, int rows) {
    TileKernels::best().add(from + at, columns, rows, to.rows, next, light);
  });
}

/// Whether the insert ends any of the rays that light the tile.
bool TileLight::shadowed(const AngleTaps& from, int angle) const {
  if (shadow_.empty()) return false;
  for (int c = 0; c < from.columns; ++c) {
    const int column = from.taps.first_cell + c - rays_.padding();
    if (column >= 0 && column < rays_.columns() && shadow_.occludes(column, angle)) return true;
  }
  return false;
}

/// How far the light of the tile's pixels reaches, and how far in the voxels are on the rays of their columns.
void TileLight::cast_shadow(const AngleTaps& from, int angle) {
  ends_.assign(product(from.columns, from.rows), InsertShadow::unhindered);
  each_piece(from, angle, Window<const Slab>{0, shadow_.ends()},
             [&](const float* ends, std::size_t at, int columns, int rows) {
               TileKernels::best().copy(ends, columns, rows, from.rows, 0, ends_.data() + at);
             });
  const model::Grid& grid = rays_.setup().grid;
  depth_.assign(product(from.taps.taps, from.taps.pitch), 0.0F);
  for (const auto& [ray, voxel] : rays_of(from)) {
    const VoxelColumn at = tile_.voxels[voxel].turned(quarters_, grid.nx);
    const double x = grid.x_mm(at.i);
    const double y = grid.y_mm(at.j);
    for (int k = 0; k < from.taps.taps; ++k) {
      const int column = std::clamp(from.taps.cell[ray] + k - rays_.padding(), 0, rays_.columns() - 1);
      depth_[product(k, from.taps.pitch) + ray] = shadow_.depth_mm(x, y, angle, column);
    }
  }
}

TileColumns TileLight::columns(const AngleTaps& from, int angle, Light& light) {
  ends_.clear();
  if (shadowed(from, angle)) cast_shadow(from, angle);
  return {light.data() + most_spread_rows,
          ends_.empty() ? nullptr : ends_.data(),
          depth_.data(),
          from.rows,
          from.first,
          from.used};
}

void TileLight::take(const TileTaps& taps, const Window<const Slab>& sinograms) {
  for (const AngleTaps& from : taps) {
    if (!from.lit) continue;
    const int angle = rays_.turned_angle(from.angle, quarters_);
    fetch(from, angle, sinograms);
    if (from.spread > 0) spread(from, light_, spread_);
    const std::vector<VoxelRay>& rays = rays_of(from);
    TileKernels::best().gather(columns(from, angle, from.spread > 0 ? spread_ : light_), from.taps, rays.data(),
                               count_of(rays), chunk_.width(), rays_.climbs(), voxels_.data() + voxel_at(0));
  }
}

void TileLight::give(const TileTaps& taps, const Window<Slab>& sinograms) {
  for (const AngleTaps& to : taps) {
    if (!to.lit) continue;
    const int angle = rays_.turned_angle(to.angle, quarters_);
    light_.assign(product(to.columns, to.rows) + product(2, most_spread_rows), 0.0F);
    const std::vector<VoxelRay>& rays = rays_of(to);
    TileKernels::best().scatter(voxels_.data() + voxel_at(0), to.taps, rays.data(), count_of(rays), chunk_.width(),
                                rays_.climbs(), columns(to, angle, light_));
    put_back(to, angle, sinograms);
  }
}

}  // namespace vam::light

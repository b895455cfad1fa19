// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/vial_operator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "optics/skew_ray.hpp"

namespace vam::light {

namespace {

constexpr int forward_angles = 16, adjoint_angles = 60;  // of a piece of work
constexpr double faint = 0.1;                            // of the best column's: grazing rays are not amplified beyond

/// Columns are projector pixels here: A f is about w (pitch / voxel) P f along a row, P the line integrals in voxels
/// and w = T e^{-mu depth}, and a ramp across columns is voxel / (J pitch) times one across voxels, which cancels the J
/// of J / T [physics §3]: the gain is (1/2) step (voxel / pitch)^2.
Preconditioner inverse_of(const VialRays& rays) {
  double most = 0;
  for (int c = 0; c < rays.columns(); ++c) most = std::max(most, rays.transmitted(c));
  std::vector<float> amplified;
  for (int c = 0; c < rays.columns(); ++c) {
    amplified.push_back(static_cast<float>(1 / std::max(rays.transmitted(c), faint * most)));
  }
  const double pitches = rays.setup().grid.voxel_mm / rays.setup().projector.pixel_mm;
  const double step_rad = std::abs(rays.setup().turn.step_rad);
  return {rays.columns(), step_rad, 0.5 * step_rad * pitches * pitches, std::move(amplified)};
}

/// Slabs in groups of as many as may share rays: 4, 2 or 1.
std::vector<Chunk> chunks(const SlabRange& slabs, int widest) {
  std::vector<Chunk> all;
  const std::size_t most = static_cast<std::size_t>(widest / lanes);
  for (std::size_t first = slabs.first; first < slabs.end; first += all.back().slabs) {
    std::size_t count = most;
    while (count > slabs.end - first) count /= 2;
    all.push_back({first, count});
  }
  return all;
}

/// Stage angles [first, end) that one piece of work covers.
std::vector<std::pair<int, int>> angle_blocks(int angles, int block) {
  std::vector<std::pair<int, int>> blocks;
  for (int first = 0; first < angles; first += block) {
    blocks.emplace_back(first, std::min(first + block, angles));
  }
  return blocks;
}

InsertShadow cast(const VialRays& rays, std::span<const Slab> inserts) {
  if (inserts.empty()) return {};
  const VialSetup& setup = rays.setup();
  std::vector<double> angles;
  for (int a = 0; a < setup.turn.rows; ++a) {
    angles.push_back(setup.part_angle_rad(a));
  }
  const double slice_mm = setup.z_scale * setup.grid.voxel_mm;
  const auto ray = [&](int column, int row, int angle) -> PixelRay {
    const double x_p = setup.projector.x_mm(rays.first_column() + column);
    const double z_p = rays.climbs() ? rays.row_mm(row) : 0;
    const model::Pose pose = rays.posed() ? setup.poses[angle] : model::Pose{};
    const bool vial = pose.moves == model::Moves::vial;
    const optics::SkewRay way = optics::skew_ray(
        setup.view, x_p, z_p, vial ? optics::Displacement{pose.dx_mm, pose.dy_mm} : optics::Displacement{});
    if (!rays.climbs()) return {way.hits, way.offset_mm, way.delta_rad, static_cast<double>(row), 0};
    const PixelRay still{way.hits, way.offset_mm, way.delta_rad,
                         way.height_mm / slice_mm - setup.grid.origin_mm[2] / setup.grid.voxel_mm,
                         way.climb / slice_mm};
    return still.seen_from(vial ? 0 : pose.dx_mm, vial ? 0 : pose.dy_mm, pose.dz_mm / slice_mm);
  };
  const int row_slabs = rays.climbs() ? (setup.rows + lanes - 1) / lanes : count_of(inserts);
  return {setup.grid, inserts, angles, rays.columns(), row_slabs, !rays.posed(), ray};
}

}  // namespace

VialOperator::VialOperator(const VialSetup& setup, std::span<const Slab> inserts)
    : rays_(setup), tiles_(tiles(rays_)), shadow_(cast(rays_, inserts)), inverse_(inverse_of(rays_)) {
  if (!rays_.climbs()) rays_.at_slices(0, 1, level_);
}

/// visit(nodes, chunk, tiles) for every tile and slab once.
template <class Visit>
void VialOperator::each_chunk(const SlabRange& slabs, const Visit& visit) const {
  RayNodes buffer;
  for (const int slices : {lanes, 2 * lanes, 4 * lanes}) {
    std::vector<int> tiles;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
      if (tiles_[t].chunk == slices) tiles.push_back(static_cast<int>(t));
    }
    if (tiles.empty()) continue;
    for (const Chunk& chunk : chunks(slabs, slices)) {
      if (rays_.climbs() && !rays_.posed()) rays_.at_slices(chunk.slice(), chunk.width(), buffer);
      visit(rays_.climbs() ? buffer : level_, chunk, tiles);
    }
  }
}

double VialOperator::row_angle_rad() const { return std::abs(rays_.setup().turn.step_rad); }

/// Stage angles of the first quarter are shared among the threads, each with those that follow it by quarters: a thread
/// writes its own rows.
void VialOperator::forward_within(const Window<const Slab>& objects, const Window<Slab>& sinograms) const {
  for (Slab& slab : sinograms.slabs) std::fill(slab.values.begin(), slab.values.end(), 0.0F);
  const auto blocks = angle_blocks(sinogram().height / rays_.quarters(), forward_angles / rays_.quarters());
  const SlabRange rows{sinograms.first, sinograms.end()};
  each_chunk({objects.first, objects.end()},
             [&](const RayNodes& nodes, const Chunk& chunk, const std::vector<int>& tiles) {
               parallel_for(count_of(blocks), [&](int b) {
                 const auto [first, end] = blocks[b];
                 for (const int t : tiles) {
                   TileLight light(rays_, shadow_, tiles_[t], chunk, rows);
                   TileTaps taps;
                   for (int quarter = 0; quarter < tiles_[t].quarters; ++quarter) {
                     light.face(quarter);
                     if (!light.load_bright_voxels(objects)) continue;
                     if (taps.empty()) taps = light.find_taps(nodes, first, end);
                     light.give(taps, sinograms);
                   }
                 }
               });
             });
}

void VialOperator::forward(std::span<const Slab> objects, std::span<Slab> sinograms) const {
  forward_within({0, objects}, {0, sinograms});
}

void VialOperator::adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const {
  adjoint_within({0, sinograms}, {0, objects});
}

SlabRange VialOperator::lit_by(const SlabRange& objects) const {
  if (!rays_.climbs()) return objects;
  const auto all = static_cast<std::size_t>((rays_.setup().rows + lanes - 1) / lanes);
  RowRange rows{rays_.setup().rows, 0};
  each_chunk(objects, [&](const RayNodes& nodes, const Chunk& chunk, const std::vector<int>&) {
    const RowRange here = rays_.rows_to(nodes, chunk.slice(), chunk.width());
    rows = {std::min(rows.first, here.first), std::max(rows.end, here.end)};
  });
  if (rows.first >= rows.end) return {all, all};
  return {static_cast<std::size_t>(rows.first / lanes), static_cast<std::size_t>((rows.end + lanes - 1) / lanes)};
}

/// Tiles are shared among the threads; all of them take the light of some angles, which stays in the cache, before any
/// takes that of the next.
void VialOperator::adjoint_within(const Window<const Slab>& sinograms, const Window<Slab>& objects) const {
  for (Slab& slab : objects.slabs) std::fill(slab.values.begin(), slab.values.end(), 0.0F);
  const auto blocks = angle_blocks(sinogram().height / rays_.quarters(), adjoint_angles / rays_.quarters());
  const SlabRange rows{sinograms.first, sinograms.end()};
  const Window<const Slab> sums{objects.first, objects.slabs};
  each_chunk({objects.first, objects.end()},
             [&](const RayNodes& nodes, const Chunk& chunk, const std::vector<int>& tiles) {
               for (const auto& [first, end] : blocks) {
                 parallel_for(count_of(tiles), [&, first = first, end = end](int item) {
                   const Tile& tile = tiles_[tiles[item]];
                   TileLight light(rays_, shadow_, tile, chunk, rows);
                   TileTaps taps;
                   for (int quarter = 0; quarter < tile.quarters; ++quarter) {
                     light.face(quarter);
                     light.load_voxels(sums);
                     if (taps.empty()) taps = light.find_taps(nodes, first, end);
                     light.take(taps, sinograms);
                     light.store_voxels(objects);
                   }
                 });
               }
             });
}

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

// SPDX-License-Identifier: GPL-3.0-or-later
// The light on a tile of voxel columns at a few stage angles: working memory of the vial operator.
#pragma once

#include <vector>

#include "base/compute/slab.hpp"
#include "light/operators/operator.hpp"
#include "light/operators/private/insert_shadow.hpp"
#include "light/operators/private/rays_kernel.hpp"
#include "light/operators/private/tiles.hpp"

namespace vam::light {

/// Slices that share a voxel column's rays: slabs [first, first + slabs).
struct Chunk {
  std::size_t first;
  std::size_t slabs;
  [[nodiscard]] int slice() const { return static_cast<int>(first) * lanes; }
  [[nodiscard]] int width() const { return static_cast<int>(slabs) * lanes; }
};

/// What lights a tile at one stage angle.
struct AngleTaps {
  int angle = 0;
  bool lit = false;
  RayTaps taps{};
  int row = 0;    // of the light that the tile's columns begin with
  int rows = 0;   // floats of a column
  int first = 0;  // those that light the voxels, but for what spreads
  int used = 0;
  int columns = 0;  // of the tile
  int spread = 0;   // of its rows, VialRays::spread()
  std::vector<VoxelRay> posed;
  std::vector<int> cells;
  std::vector<float, CacheAligned<float>> floats;
  void make_room(std::size_t rays, int most_taps);
};
using TileTaps = std::vector<AngleTaps>;

/// A tile is so small that at one stage angle its light comes from a few columns: these are brought together, and stay
/// in the first cache. A voxel's taps are summed row by row, and the sum is taken to its slices. Taps are found once,
/// for all quarters of a turn: load voxels, find_taps(), take() or give(), store voxels.
class TileLight {
 public:
  /// `rows`: the slabs of light that there will be.
  TileLight(const VialRays& rays, const InsertShadow& shadow, const Tile& tile, const Chunk& chunk,
            const SlabRange& rows);

  /// The tile so many quarters of a turn on, from now on.
  void face(int quarters) { quarters_ = quarters; }
  /// What the voxels take and give from now on.
  void load_voxels(const Window<const Slab>& objects);
  /// Those that have anything to give: the others and their rays are left out. False where there are none.
  bool load_bright_voxels(const Window<const Slab>& objects);
  void store_voxels(const Window<Slab>& objects) const;

  /// What lights the tile at stage angles [first, end) and at those that follow them by quarters of a turn, which
  /// light the tile that many quarters on alike; with poses, what lights the voxels that are loaded. `nodes`: those at
  /// the chunk.
  [[nodiscard]] TileTaps find_taps(const RayNodes& nodes, int first, int end);
  /// Voxels += light of these angles.
  void take(const TileTaps& taps, const Window<const Slab>& sinograms);
  /// Its transpose: light += voxels.
  void give(const TileTaps& taps, const Window<Slab>& sinograms);

 private:
  using Light = std::vector<float, CacheAligned<float>>;
  template <class Visit>
  void each_voxel(const Visit& visit) const;
  template <class SlabType, class Visit>
  void each_piece(const AngleTaps& from, int angle, const Window<SlabType>& sinograms, const Visit& visit) const;
  [[nodiscard]] std::size_t voxel_at(int voxel) const;
  [[nodiscard]] bool bright(int voxel) const;
  void find_angle(const RayNodes& nodes, AngleTaps& to);
  void find_posed(AngleTaps& to);
  void fetch(const AngleTaps& from, int angle, const Window<const Slab>& sinograms);
  void put_back(const AngleTaps& to, int angle, const Window<Slab>& sinograms);
  [[nodiscard]] int spread_of(const AngleTaps& at) const;
  /// Of the rows of `from`, to `to`.
  void spread(const AngleTaps& over, const Light& from, Light& to) const;
  void cast_shadow(const AngleTaps& from, int angle);
  [[nodiscard]] bool shadowed(const AngleTaps& from, int angle) const;
  [[nodiscard]] TileColumns columns(const AngleTaps& from, int angle, Light& light);
  /// The rays of the voxels that are loaded.
  [[nodiscard]] const std::vector<VoxelRay>& rays_of(const AngleTaps& from) const {
    return rays_.posed() ? from.posed : voxel_rays_;
  }

  const VialRays& rays_;
  const InsertShadow& shadow_;
  const Tile& tile_;
  const Chunk chunk_;
  int lit_first_, lit_end_;  // rows
  int quarters_ = 0;
  bool bright_only_ = false;
  std::vector<VoxelRay> voxel_rays_;  // of the voxels that are loaded
  RayNodes posed_nodes_;              // of one frame
  Light light_, spread_;              // most_spread_rows floats before and after the columns
  std::vector<float, CacheAligned<float>> voxels_, ends_, depth_;
};

}  // namespace vam::light

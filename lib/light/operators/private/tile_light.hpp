// The light on a tile of voxel columns: working memory of the vial operator, one per thread.
#pragma once

#include <span>
#include <vector>

#include "base/slab.hpp"
#include "light/operators/operator.hpp"
#include "light/operators/private/insert_shadow.hpp"
#include "light/operators/private/rays_kernel.hpp"
#include "light/rays/vial_rays.hpp"

namespace vam::light {

/// Slices that share a voxel column's rays: slabs [first, first + slabs).
struct Chunk {
  std::size_t first;
  std::size_t slabs;
  [[nodiscard]] int slice() const { return static_cast<int>(first) * lanes; }
  [[nodiscard]] int width() const { return static_cast<int>(slabs) * lanes; }
};

/// The rays of a tile's voxels, in whole blocks; those that fill up the last block belong to no voxel. With poses the
/// voxels alone: they have other rays in every frame.
struct Tile {
  int chunk = 0;  // slices that may share the rays
  std::vector<RaySource> rays;
  std::vector<int> voxels;  // whose ray it is, within the tile
};

/// A tile is so small that at one stage angle its light comes from a few columns: these are brought together, and all
/// stays in the first cache. A voxel's taps are summed row by row, and the sum is taken to its slices.
class TileLight {
 public:
  static constexpr int edge = 8;  // voxels
  static_assert(edge * edge * VialRays::most_rays <= ray_block * most_blocks);
  /// The rays of all tiles, at any stage angle.
  static std::vector<Tile> tiles(const VialRays& rays);

  TileLight(const VialRays& rays, const InsertShadow& shadow);

  void enter(int tile, const Tile& rays, const Chunk& chunk);
  /// What the voxels take and give from now on.
  void clear_voxels() { std::fill(voxels_.begin(), voxels_.end(), 0.0F); }
  /// What they have taken so far.
  void load_voxels(const Window<const Slab>& objects);
  /// Those that have anything to give: the others and their rays are left out.
  void load_bright_voxels(const Window<const Slab>& objects);
  void store_voxels(const Window<Slab>& objects) const;

  /// Voxels += light of a stage angle.
  void take(const RayNodes& nodes, int angle, const Window<const Slab>& sinograms);
  /// Its transpose: light += voxels.
  void give(const RayNodes& nodes, int angle, const Window<Slab>& sinograms);

 private:
  template <class Visit>
  void each_voxel(const Visit& visit) const;
  /// False where no light comes.
  bool find_taps(const RayNodes& nodes, int angle, const SlabRange& rows);
  bool find_posed_taps(int frame);
  void make_room(std::size_t pitch);
  void keep_bright();
  template <class SlabType, class Visit>
  void each_piece(int angle, const Window<SlabType>& sinograms, const Visit& visit) const;
  void fetch(int angle, const Window<const Slab>& sinograms);
  void put_back(int angle, const Window<Slab>& sinograms) const;
  void cast_shadow(int angle);
  [[nodiscard]] bool shadowed(int angle) const;
  [[nodiscard]] TileColumns columns();
  /// Of every ray.
  [[nodiscard]] const std::vector<int>& voxels() const { return rays_.posed() ? posed_voxels_ : tile_->voxels; }
  [[nodiscard]] int count() const { return static_cast<int>(voxels().size()); }

  const VialRays& rays_;
  const InsertShadow& shadow_;
  Chunk chunk_{};
  int i0_ = 0, i1_ = 0, j0_ = 0, j1_ = 0;
  const Tile* tile_ = nullptr;
  Tile bright_;  // of tile_, where voxels give
  RayTaps taps_{};
  int row_ = 0;      // of the light that the tile's columns begin with
  int rows_ = 0;     // floats of a column
  int columns_ = 0;  // of the tile
  int lit_first_ = 0, lit_end_ = 0;
  RayNodes posed_nodes_;  // of one frame
  std::vector<int> posed_voxels_;
  std::vector<int> cells_;
  std::vector<float, CacheAligned<float>> floats_, voxels_, light_, ends_, depth_;
};

}  // namespace vam::light

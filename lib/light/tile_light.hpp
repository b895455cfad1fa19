// The light on a tile of voxel columns: a working space for the vial's pair, one a thread.
#pragma once

#include <span>
#include <vector>

#include "base/slab.hpp"
#include "light/insert_shadow.hpp"
#include "light/vial_rays.hpp"

namespace vam::light {

/// Slices that share a voxel column's rays: slabs [first, first + slabs).
struct Chunk {
  std::size_t first;
  std::size_t slabs;
  [[nodiscard]] int slice() const { return static_cast<int>(first) * lanes; }
  [[nodiscard]] int width() const { return static_cast<int>(slabs) * lanes; }
};

/// A tile is small, so at one stage angle its light comes from a few columns, and where rays climb its voxels see the
/// rows under nearly the same zoom. The rows are taken to the tile's slices once, under the least and the largest zoom
/// (two planes), and each voxel interpolates between the planes. Between two rows all of this is linear, so the voxel's
/// value is the rows' at its own place, blurred at most by a quarter of the planes' distance.
class TileLight {
 public:
  /// A ray of one of a tile's voxels.
  struct Entry {
    TapSource ray;
    int voxel;  // within the tile
  };
  /// The rays of every tile's voxels, at any stage angle.
  static std::vector<std::vector<Entry>> tiles(const VialRays& rays);

  TileLight(const VialRays& rays, const InsertShadow& shadow);

  void enter(int tile, std::span<const Entry> entries, const Chunk& chunk);
  /// What the voxels take and give from now on, width() floats a voxel of the tile.
  void clear_voxels() { std::fill(voxels_.begin(), voxels_.end(), 0.0F); }
  void load_voxels(std::span<const Slab> objects);
  void store_voxels(std::span<Slab> objects) const;

  /// Voxels += light of stage angles [angle, angle + count), count <= tap_angles.
  void take(const RayNodes& nodes, int angle, int count, std::span<const Slab> sinograms);
  /// Its transpose: light += voxels.
  void give(const RayNodes& nodes, int angle, int count, std::span<Slab> sinograms);

 private:
  /// The columns and planes of the tile at one stage angle.
  struct Planes {
    int column = 0, columns = 0;
    float row[2] = {0, 0};  // of slice 0
    float zoom[2] = {1, 1};
  };
  template <class Row>
  void each_voxel(const Row& visit) const;
  void aim(const RayNodes& nodes, int angle, int count);
  void split(int angle, Planes& planes);
  void fetch(const Planes& planes, int angle, std::span<const Slab> sinograms);
  void put_back(const Planes& planes, int angle, std::span<Slab> sinograms);
  [[nodiscard]] bool shadowed(int angle, int index) const;
  void take_shadowed(int angle, int index, std::span<const Slab> sinograms);
  void give_shadowed(int angle, int index, std::span<Slab> sinograms);
  template <class Visit>
  void each_shadowed(int angle, int index, std::size_t slabs, const Visit& visit);
  struct Rows {
    int first, end;
  };
  [[nodiscard]] Rows lit_rows(std::size_t slabs) const;

  const VialRays& rays_;
  const InsertShadow& shadow_;
  Chunk chunk_{};
  int i0_ = 0, i1_ = 0, j0_ = 0, j1_ = 0;
  int planes_;
  int edge_;
  std::span<const Entry> entries_;
  std::vector<int> voxel_of_;                        // an entry each
  std::vector<Taps> taps_;                           // an entry each
  std::vector<PlaneTaps> split_;                     // an entry each
  std::vector<Planes> at_;                           // a stage angle each
  std::vector<float, CacheAligned<float>> weights_;  // of taps_, and of both planes of split_
  std::vector<float, CacheAligned<float>> voxels_, light_, line_;
};

}  // namespace vam::light

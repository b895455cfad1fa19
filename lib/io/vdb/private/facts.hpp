// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the VDB files: a grid's facts beside its voxels, and the seals of both.
#pragma once

#include <openvdb/openvdb.h>

#include <optional>
#include <string>

#include "base/text/printable.hpp"
#include "io/stream/seal.hpp"
#include "io/vdb/private/leaf_store.hpp"
#include "io/vdb/private/serialisation.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

inline constexpr const char* history_key = "vam:history";
inline constexpr const char* units_key = "vam:units";
inline constexpr const char* shape_key = "vam:shape";  // voxels along x, y, z: the requested box, padding included
inline constexpr const char* first_key = "vam:first_index";  // of that box, where it is not 0

/// Name, box, place and metadata of a grid whose topology has been read; its voxels need not be. `first` becomes the
/// index of voxel (0, 0, 0). Throws std::runtime_error: a transform that is not uniform along the axes, an impossible
/// or empty box.
[[nodiscard]] VolumeFacts facts_of(const openvdb::FloatGrid& sparse, openvdb::Coord& first);

/// Of these what stands before the topology: name, class and metadata.
[[nodiscard]] VolumeFacts head_of(const openvdb::FloatGrid& sparse);

/// The error of a name that two grids of a file have.
[[nodiscard]] inline std::string occurs_twice(const std::string& name) {
  return "grid " + excerpt(name) + " occurs twice; keep one of them, or rename it";
}

/// Of name, class, transform and every vam: metadata: what is read before the voxels.
[[nodiscard]] Digest facts_digest(const openvdb::FloatGrid& sparse);

/// Takes the voxels of a tree: begin(), then leaves in the order of the tree.
class VoxelSealer {
 public:
  /// Background, tiles, and what is active: the box of a grid is known from this, before its values are.
  void begin(const openvdb::FloatTree& tree);
  void add(const LeafRecord& leaf) { sealer_.add(&leaf, sizeof leaf); }
  [[nodiscard]] Digest digest() const { return sealer_.digest(); }

 private:
  Sealer sealer_;
};

/// Calls take(TileRecord) for what a tree stores above its leaves, the background left out.
template <class Take>
void for_tiles(const openvdb::FloatTree& tree, const Take& take) {
  auto tile = tree.cbeginValueAll();
  tile.setMaxDepth(openvdb::FloatTree::DEPTH - 2);
  for (; tile; ++tile) {
    if (*tile == tree.background() && !tile.isValueOn()) continue;
    openvdb::CoordBBox box;
    tile.getBoundingBox(box);
    const openvdb::Coord at = box.min();
    take(TileRecord{{at.x(), at.y(), at.z()}, static_cast<std::int32_t>(tile.getLevel()), *tile, tile.isValueOn()});
  }
}

[[nodiscard]] LeafRecord record_of(const openvdb::FloatTree::LeafNodeType& leaf, const float* values);

/// Puts both into the metadata; everything else must be in place.
void seal(openvdb::FloatGrid& sparse, const LeafStore& leaves);

struct GridSeals {
  Digest facts;
  Digest values;
};
/// Nothing where there is none; the facts are judged. Throws std::runtime_error: a version that is not read, one of
/// the two is missing or damaged, the facts are not those that were written.
[[nodiscard]] std::optional<GridSeals> judged_seals(const openvdb::FloatGrid& sparse);

/// The grid's seal, also as a line of its history.
void add_seal(const std::optional<GridSeals>& seals, VolumeFacts& facts);

}  // namespace vam::io

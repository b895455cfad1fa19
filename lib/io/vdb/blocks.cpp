// A grid's voxels one leaf (8 x 8 x 8) at a time. An archive holds a tree's topology first and the leaves' values after
// it, in the order of the tree: so each leaf is read when its turn comes, shown and let go.
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "base/error.hpp"
#include "io/stream/finite.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/private/archive.hpp"
#include "io/vdb/private/facts.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using Tree = FloatGrid::TreeType;
using Leaf = Tree::LeafNodeType;
using Begin = std::function<BlockTaker(const VolumeFacts&)>;

// OpenVDB reads name, metadata, transform and topology of a grid before it calls readBuffers().
class PassingGrid : public FloatGrid {
 public:
  PassingGrid(std::string wanted, const Begin& begin, bool& found)
      : wanted_(std::move(wanted)), begin_(begin), found_(found) {}

  void readBuffers(std::istream& stream) override {
    const bool shown = getName() == wanted_ && !found_;
    BlockTaker take;
    if (shown) {
      found_ = true;
      const VolumeFacts facts = facts_of(*this, first_);
      take = begin_(facts);
      check(std::isfinite(facts.background));
      pass_tiles(take);
    }
    for (auto leaf = tree().beginLeaf(); leaf; ++leaf) {
      leaf->readBuffers(stream, saveFloatAsHalf());
      if (shown) pass(*leaf, take);
      Leaf::Buffer gone(openvdb::PartialCreate(), 0.0F);
      leaf->swap(gone);
    }
  }
  void readBuffers(std::istream& stream, const CoordBBox&) override { readBuffers(stream); }

 private:
  void check(bool finite) const {
    if (!finite) throw std::runtime_error("grid '" + getName() + "' has a value that is not a finite number");
  }

  void pass_tiles(const BlockTaker& take) const {
    auto tile = constTree().cbeginValueAll();
    tile.setMaxDepth(Tree::DEPTH - 2);  // above the leaves
    for (; tile; ++tile) {
      if (*tile == background()) continue;
      check(std::isfinite(*tile));
      CoordBBox box;
      tile.getBoundingBox(box);
      take(block_at(box.min(), box.dim().x(), nullptr, *tile));
    }
  }

  void pass(const Leaf& leaf, const BlockTaker& take) const {
    const float* values = leaf.buffer().data();
    check(all_finite(values, Leaf::SIZE));
    take(block_at(leaf.origin(), static_cast<int>(Leaf::DIM), values, 0));
  }

  VoxelBlock block_at(const Coord& corner, int edge, const float* values, float value) const {
    const Coord at = corner - first_;
    return {at.x(), at.y(), at.z(), edge, values, value};
  }

  std::string wanted_;
  const Begin& begin_;
  bool& found_;
  Coord first_;
};

struct Archive : openvdb::io::Archive {
  // The grids of one archive; their names are added to `names`.
  void pass(std::istream& stream, const std::string& wanted, const Begin& begin, bool& found, std::string& names) {
    readHeader(stream);
    openvdb::io::StreamMetadata::Ptr facts = std::make_shared<openvdb::io::StreamMetadata>();
    openvdb::io::setStreamMetadataPtr(stream, facts, false);
    setFormatVersion(stream);
    setLibraryVersion(stream);
    setDataCompression(stream);
    openvdb::MetaMap().readMeta(stream);
    for (auto left = readGridCount(stream); left > 0; --left) {
      openvdb::io::GridDescriptor about;
      openvdb::GridBase::Ptr grid = about.read(stream);
      names += (names.empty() ? "" : ", ") + about.gridName();
      if (about.gridType() != FloatGrid::gridType()) names += " (" + grid->valueType() + ")";
      if (about.gridType() == FloatGrid::gridType()) {
        grid = std::make_shared<PassingGrid>(wanted, begin, found);
        grid->setSaveFloatAsHalf(about.saveFloatAsHalf());
        if (about.isInstance() && about.gridName() == wanted) {
          throw std::runtime_error("grid '" + wanted + "' shares the voxels of '" + about.instanceParentName() +
                                   "'; write it as a grid of its own");
        }
      }
      readGrid(grid, about, stream);
    }
  }
};

}  // namespace

void read_blocks(const std::string& path, const std::string& name, const Begin& begin) {
  InputFile file(path);
  bool found = false;
  std::string names;
  for_archives(file, [&](std::istream& stream) { Archive().pass(stream, name, begin, found, names); });
  if (!found) throw Error{Fault::data, file.name() + ": has no grid '" + name + "', but " + names};
}

}  // namespace vam::io

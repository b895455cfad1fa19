// A grid's voxels one leaf (8 x 8 x 8) at a time. An archive holds a tree's topology first and the leaves' values after
// it, in the order of the tree: so each leaf is read when its turn comes, sent and let go. This runs in the child: it
// starts no threads, and what would start some to be destroyed stays.
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "io/stream/finite.hpp"
#include "io/vdb/private/archive.hpp"
#include "io/vdb/private/facts.hpp"
#include "io/vdb/private/passage.hpp"

namespace vam::io {

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using Tree = FloatGrid::TreeType;
using Leaf = Tree::LeafNodeType;

static_assert(Leaf::SIZE == 512 && Leaf::NodeMaskType::WORD_COUNT == 8, "what a LeafRecord holds");

std::array<std::int32_t, 3> numbers(const Coord& at) { return {at.x(), at.y(), at.z()}; }

// OpenVDB reads name, metadata, transform and topology of a grid before it calls readBuffers().
class PassingGrid : public FloatGrid {
 public:
  PassingGrid(std::string unique_name, bool shown, Sender& out)
      : unique_name_(std::move(unique_name)), shown_(shown), out_(out) {}

  void readBuffers(std::istream& stream) override {
    if (shown_) {
      send("");
      send_tiles();
    }
    for (auto leaf = tree().beginLeaf(); leaf; ++leaf) {
      leaf->readBuffers(stream, saveFloatAsHalf());
      if (shown_) send(*leaf);
      Leaf::Buffer gone(openvdb::PartialCreate(), 0.0F);
      leaf->swap(gone);
    }
  }
  void readBuffers(std::istream& stream, const CoordBBox&) override { readBuffers(stream); }

  void send(const std::string& shares) const {
    GridHead head;
    head.facts = facts_of(*this, head.first);
    head.unique_name = unique_name_;
    head.shares = shares;
    const openvdb::Vec3d zero = indexToWorld(Coord(0));
    head.zero_mm = {zero.x(), zero.y(), zero.z()};
    check(std::isfinite(head.facts.background));
    send_head(std::move(head), out_);
  }

 private:
  void check(bool finite) const {
    if (!finite) throw std::runtime_error("grid '" + getName() + "' has a value that is not a finite number");
  }

  void send_tiles() const {
    auto tile = constTree().cbeginValueAll();
    tile.setMaxDepth(Tree::DEPTH - 2);  // above the leaves
    for (; tile; ++tile) {
      if (*tile == background() && !tile.isValueOn()) continue;
      check(std::isfinite(*tile));
      CoordBBox box;
      tile.getBoundingBox(box);
      out_.put(Record::tile);
      out_.put(TileRecord{numbers(box.min()), static_cast<std::int32_t>(tile.getLevel()), *tile, tile.isValueOn()});
    }
  }

  void send(const Leaf& leaf) const {
    LeafRecord record;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled at once
    record.corner = numbers(leaf.origin());
    record.padding = 0;
    for (openvdb::Index word = 0; word < Leaf::NodeMaskType::WORD_COUNT; ++word) {
      record.active[word] = leaf.valueMask().getWord<openvdb::Index64>(word);
    }
    std::copy_n(leaf.buffer().data(), Leaf::SIZE, record.values.data());
    check(all_finite(record.values.data(), Leaf::SIZE));
    out_.put(Record::leaf);
    out_.put(record);
  }

  std::string unique_name_;
  bool shown_;
  Sender& out_;
};

// The grids of one archive after the other.
class Archive : public openvdb::io::Archive {
 public:
  Archive(const std::optional<std::string>& wanted, Sender& out) : wanted_(wanted), out_(out) {}

  void pass(std::istream& stream) {
    readHeader(stream);
    openvdb::io::StreamMetadata::Ptr facts = std::make_shared<openvdb::io::StreamMetadata>();
    openvdb::io::setStreamMetadataPtr(stream, facts, false);
    setFormatVersion(stream);
    setLibraryVersion(stream);
    setDataCompression(stream);
    openvdb::MetaMap().readMeta(stream);
    std::map<std::string, PassingGrid*> grids;  // of this archive
    for (auto left = readGridCount(stream); left > 0; --left) {
      openvdb::io::GridDescriptor about;
      const openvdb::GridBase::Ptr grid = about.read(stream);
      kept_.push_back(grid);
      if (about.gridType() == FloatGrid::gridType()) {
        pass_floats(about, stream, grids);
      } else {
        readGrid(grid, about, stream);
        out_.put(Record::other);
        out_.put(grid->getName() + " (" + grid->valueType() + ")");
      }
    }
  }

 private:
  void pass_floats(const openvdb::io::GridDescriptor& about, std::istream& stream,
                   std::map<std::string, PassingGrid*>& grids) {
    const bool shown = !wanted_ || (about.gridName() == *wanted_ && !found_);
    const auto grid = std::make_shared<PassingGrid>(about.uniqueName(), shown, out_);
    kept_.push_back(grid);
    grids[about.uniqueName()] = grid.get();
    grid->setSaveFloatAsHalf(about.saveFloatAsHalf());
    if (wanted_ && about.isInstance() && about.gridName() == *wanted_) {
      throw std::runtime_error("grid '" + *wanted_ + "' shares the voxels of '" + about.instanceParentName() +
                               "'; write it as a grid of its own");
    }
    found_ = found_ || shown;
    readGrid(grid, about, stream);
    if (!shown) {
      out_.put(Record::other);
      out_.put(about.gridName());
    } else if (about.isInstance()) {
      const auto parent = grids.find(about.instanceParentName());
      if (parent == grids.end()) throw std::runtime_error("grid '" + about.gridName() + "' shares unknown voxels");
      grid->setTree(parent->second->treePtr());
      grid->send(about.instanceParentName());
    }
  }

  const std::optional<std::string>& wanted_;
  Sender& out_;
  bool found_ = false;
  std::vector<openvdb::GridBase::Ptr>& kept_ = *new std::vector<openvdb::GridBase::Ptr>;  // for ever
};

}  // namespace

void send_archives(InputFile& file, const std::optional<std::string>& wanted, Sender& out) {
  Archive archive(wanted, out);
  for_archives(file, [&](std::istream& stream) { archive.pass(stream); });
  out.put(Record::end);
}

}  // namespace vam::io

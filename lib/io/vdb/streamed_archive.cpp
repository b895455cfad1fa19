// SPDX-License-Identifier: GPL-3.0-or-later
// A grid's voxels one leaf (8 x 8 x 8) at a time. An archive holds a tree's topology first and the leaves' values after
// it, in the order of the tree: so each leaf is read when its turn comes, sent and let go. This runs in the
// single-threaded child: grids are leaked, as their destructors use threads.
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

#include "base/text/printable.hpp"
#include "io/stream/finite.hpp"
#include "io/vdb/private/facts.hpp"
#include "io/vdb/private/serialisation.hpp"

namespace vam::io {

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using Tree = FloatGrid::TreeType;
using Leaf = Tree::LeafNodeType;

static_assert(Leaf::SIZE == 512 && Leaf::NodeMaskType::WORD_COUNT == 8, "what a LeafRecord holds");

// OpenVDB reads name, metadata, transform and topology of a grid before it calls readBuffers().
class StreamedGrid : public FloatGrid {
 public:
  StreamedGrid(std::string unique_name, Sender& out) : unique_name_(std::move(unique_name)), out_(out) {}

  // A sealed grid is held to its seals, the head before its topology is read.
  void readTopology(std::istream& stream) override {
    take_seals();
    FloatGrid::readTopology(stream);
  }
  void send_head_alone(std::istream& stream) {
    readMeta(stream);
    readTransform(stream);
    take_seals();
    GridHead head;
    head.facts = head_of(*this);
    head.unique_name = unique_name_;
    send_head(head);
  }
  void take_seals() { seals_ = judged_seals(*this); }

  void readBuffers(std::istream& stream) override {
    VoxelSealer voxels;
    if (seals_) voxels.begin(constTree());
    send("");
    send_tiles();
    for (auto leaf = tree().beginLeaf(); leaf; ++leaf) {
      leaf->readBuffers(stream, saveFloatAsHalf());
      send(*leaf, voxels);
      Leaf::Buffer gone(openvdb::PartialCreate(), 0.0F);
      leaf->swap(gone);
    }
    values_ = voxels.digest();
    judge(values_);
  }
  void readBuffers(std::istream& stream, const CoordBBox&) override { readBuffers(stream); }

  void send(const std::string& shares) {
    GridHead head;
    head.facts = facts_of(*this, head.first);
    head.unique_name = unique_name_;
    head.shares = shares;
    const openvdb::Vec3d zero = indexToWorld(Coord(0));
    head.zero_mm = {zero.x(), zero.y(), zero.z()};
    first_ = head.first;
    if (!std::isfinite(head.facts.background)) refuse("a background");
    send_head(head);
  }

  // A grid that shares the voxels of another has seals of its own.
  void judge(const Digest& values) const {
    if (!seals_ || seals_->values == values) return;
    throw std::runtime_error(mismatch("grid " + excerpt(getName()), seals_->values, values));
  }
  [[nodiscard]] const Digest& values() const { return values_; }
  [[nodiscard]] bool sealed() const { return seals_.has_value(); }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::runtime_error("grid " + excerpt(getName()) + " has " + what +
                             " that is not a finite number; mend it in the program that wrote it");
  }
  [[noreturn]] void refuse_voxel(const Coord& at) const {
    const Coord place = at - first_;
    refuse("a value in voxel (" + std::to_string(place.x()) + ", " + std::to_string(place.y()) + ", " +
           std::to_string(place.z()) + ")");
  }

  void send_head(GridHead& head) const {
    add_seal(seals_, head.facts);
    out_.put(Record::grid);
    out_.put(members(head));
  }

  void send_tiles() const {
    for_tiles(constTree(), [this](const TileRecord& tile) {
      if (!std::isfinite(tile.value)) refuse_voxel(Coord(tile.corner.data()));
      out_.put(Record::tile);
      out_.put(tile);
    });
  }

  void send(const Leaf& leaf, VoxelSealer& voxels) const {
    const LeafRecord record = record_of(leaf, leaf.buffer().data());
    if (seals_) voxels.add(record);
    if (!all_finite(record.values.data(), Leaf::SIZE)) {
      const auto* const bad =
          std::find_if_not(record.values.begin(), record.values.end(), [](float v) { return std::isfinite(v); });
      refuse_voxel(leaf.offsetToGlobalCoord(static_cast<openvdb::Index>(bad - record.values.begin())));
    }
    out_.put(Record::leaf);
    out_.put(record);
  }

  std::string unique_name_;
  Sender& out_;
  std::optional<GridSeals> seals_;
  Digest values_;
  Coord first_;  // voxel of the volume
};

// The grids of one archive after the other.
class StreamedArchive : public openvdb::io::Archive {
 public:
  StreamedArchive(bool heads_alone, Sender& out, std::vector<std::shared_ptr<void>>& kept)
      : heads_alone_(heads_alone), out_(out), kept_(kept) {}

  void pass(std::istream& stream) {
    first_ = nullptr;
    readHeader(stream);
    openvdb::io::StreamMetadata::Ptr facts = std::make_shared<openvdb::io::StreamMetadata>();
    openvdb::io::setStreamMetadataPtr(stream, facts, false);
    setFormatVersion(stream);
    setLibraryVersion(stream);
    setDataCompression(stream);
    openvdb::MetaMap().readMeta(stream);
    std::map<std::string, StreamedGrid*> grids;  // of this archive
    auto left = readGridCount(stream);
    if (left == 0) throw std::runtime_error("has no grids; the program that wrote it had nothing to write");
    for (; left > 0; --left) {
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
                   std::map<std::string, StreamedGrid*>& grids) {
    const auto grid = std::make_shared<StreamedGrid>(about.uniqueName(), out_);
    kept_.push_back(grid);
    grids[about.uniqueName()] = grid.get();
    grid->setSaveFloatAsHalf(about.saveFloatAsHalf());
    const bool new_order = openvdb::io::getFormatVersion(stream) >= openvdb::OPENVDB_FILE_VERSION_GRID_INSTANCING;
    if (heads_alone_ && new_order && about.getEndPos() > stream.tellg()) {
      readGridCompression(stream);
      grid->send_head_alone(stream);
      require_seals(*grid);
      stream.seekg(about.getEndPos() - stream.tellg(), std::ios_base::cur);
      return;
    }
    readGrid(grid, about, stream);
    if (about.isInstance()) grid->take_seals();
    require_seals(*grid);
    if (!about.isInstance()) return;
    const auto parent = grids.find(about.instanceParentName());
    if (parent == grids.end()) throw std::runtime_error("grid " + excerpt(about.gridName()) + " shares unknown voxels");
    grid->setTree(parent->second->treePtr());
    grid->judge(parent->second->values());
    grid->send(about.instanceParentName());
  }

  // The tools seal every grid of an archive. Weights and tolerances are also added by other programs.
  void require_seals(const StreamedGrid& grid) {
    if (grid.getName() == "weight" || grid.getName() == "tolerance") return;
    if (!first_) first_ = &grid;
    if (grid.sealed() == first_->sealed()) return;
    const StreamedGrid& sealed = grid.sealed() ? grid : *first_;
    const StreamedGrid& other = grid.sealed() ? *first_ : grid;
    throw std::runtime_error("grid " + excerpt(sealed.getName()) + " is sealed, and grid " + excerpt(other.getName()) +
                             " is not; make the file again");
  }

  bool heads_alone_;
  Sender& out_;
  const StreamedGrid* first_ = nullptr;  // of this archive; on one stream archives of several programs may follow
  std::vector<std::shared_ptr<void>>& kept_;
};

}  // namespace

void pass_archives(InputFile& file, bool heads_alone, Sender& out, std::vector<std::shared_ptr<void>>& kept) {
  StreamedArchive archive(heads_alone, out, kept);
  for_archives(file, [&](std::istream& stream) { archive.pass(stream); });
  out.put(Record::end);
}

void send_archives(InputFile& file, bool heads_alone, Sender& out) {
  pass_archives(file, heads_alone, out, *new std::vector<std::shared_ptr<void>>);  // for ever
}

}  // namespace vam::io

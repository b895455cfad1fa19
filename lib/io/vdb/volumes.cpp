// SPDX-License-Identifier: GPL-3.0-or-later
// Out of the records of the child that reads archives: volumes, where leaves and tiles are inserted into trees.
#include <array>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/private/facts.hpp"
#include "io/vdb/private/leaf_store.hpp"
#include "io/vdb/private/serialisation.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using Leaf = FloatGrid::TreeType::LeafNodeType;

class VolumeBuilder {
 public:
  explicit VolumeBuilder(Receiver& in) : in_(in) {}

  std::vector<SparseVolume> volumes;
  [[nodiscard]] const std::string& others() const { return others_; }

  // From the unit map, as SparseVolume does, so that a grid that is written again keeps its numbers to the last bit.
  void start(GridHead head) {
    SparseVolume& volume = volumes.emplace_back(head.facts.name, head.facts.grid, head.facts.background);
    const auto transform = openvdb::math::Transform::createLinearTransform();
    transform->preScale(head.facts.grid.voxel_mm);
    transform->postTranslate({head.zero_mm[0], head.zero_mm[1], head.zero_mm[2]});
    SparseVolume::State& state = volume.state();
    state.first = head.first;
    if (const auto owner = by_name_.find(head.shares); !head.shares.empty() && owner != by_name_.end()) {
      state.sparse = FloatGrid::create(owner->second->sparse->treePtr());
      state.leaves = owner->second->leaves;
    }
    state.sparse->setTransform(transform);
    by_name_[head.unique_name] = &state;
    volume.history = std::move(head.facts.history);
    volume.units = std::move(head.facts.units);
    volume.metadata = std::move(head.facts.metadata);
    volume.level_set = head.facts.level_set;
    accessor_ = std::make_unique<Accessor>(state.sparse->tree());
    leaves_ = state.leaves.get();
  }

  void other(const std::string& text) { others_ += " " + text; }

  void tile(const TileRecord& tile) {
    if (!accessor_) return;
    const auto level = static_cast<openvdb::Index>(tile.level);
    accessor_->addTile(level, Coord(tile.corner.data()), tile.value, tile.active != 0);
  }

  // Values go from the record into the leaf's own memory at once.
  void leaf() {
    static_assert(offsetof(LeafRecord, corner) == 64 && offsetof(LeafRecord, values) == 80);
    const auto words = in_.get<std::array<std::uint64_t, Leaf::NodeMaskType::WORD_COUNT>>();
    const auto corner = in_.get<std::array<std::int32_t, 4>>();
    auto made = std::make_unique<Leaf>(openvdb::PartialCreate(), Coord(corner.data()), 0.0F, false);
    made->allocate();
    Leaf::NodeMaskType active;
    for (openvdb::Index word = 0; word < words.size(); ++word) active.getWord<openvdb::Index64>(word) = words[word];
    made->setValueMask(active);
    in_.get(made->buffer().data(), Leaf::SIZE * sizeof(float));
    if (!accessor_) return;
    leaves_->add(*made, accessor_->probeConstLeaf(made->origin()));
    accessor_->addLeaf(made.release());
  }

 private:
  Receiver& in_;
  std::map<std::string, const SparseVolume::State*> by_name_;  // the unique name of the archive; the last of that name
  std::unique_ptr<Accessor> accessor_;
  LeafStore* leaves_ = nullptr;  // of that tree
  std::string others_;
};

void receive_file(const std::string& path, bool heads_alone, const std::function<void(Receiver&)>& take) {
  InputFile file(path);
  openvdb::initialize();
  read_apart(
      {file.name(), file.size(), file.descriptor()}, [&](Sender& out) { send_archives(file, heads_alone, out); }, take);
}

}  // namespace

std::vector<SparseVolume> read_volumes(const std::string& path) {
  std::vector<SparseVolume> volumes;
  std::string others;
  receive_file(path, false, [&](Receiver& in) {
    VolumeBuilder builder(in);
    receive_records(in, builder);
    volumes = std::move(builder.volumes);
    others = builder.others();
  });
  if (volumes.empty()) {
    throw Error{Fault::data,
                input_name(path) + ": holds no grid of floats" + (others.empty() ? std::string() : ", but" + others)};
  }
  return volumes;
}

SparseVolume& choose_volume(std::vector<SparseVolume>& volumes, const std::string& name, const std::string& path) {
  const std::string subject = input_name(path);
  SparseVolume* found = nullptr;
  std::string names;
  std::set<std::string> known;
  for (SparseVolume& volume : volumes) {
    const bool is_new = known.insert(volume.name()).second;
    if (name.empty() && !is_new) throw Error{Fault::data, subject + ": " + occurs_twice(volume.name())};
    names += (names.empty() ? "" : ", ") + volume.name();
    if (volume.name() != name && !(name.empty() && volumes.size() == 1)) continue;
    if (found != nullptr) throw Error{Fault::data, subject + ": " + occurs_twice(name)};
    found = &volume;
  }
  if (found != nullptr) return *found;
  if (name.empty())
    throw Error{Fault::data, subject + ": holds several grids (" + briefly(names) + "); choose one by name"};
  throw Error{Fault::data, subject + ": has no grid '" + name + "'; choose one of " + briefly(names)};
}

SparseVolume read_volume(const std::string& path, const std::string& name) {
  std::vector<SparseVolume> volumes = read_volumes(path);
  return std::move(choose_volume(volumes, name, path));
}

namespace {

struct HeadTaker {
  Receiver& in;
  std::vector<VolumeFacts> all = {};
  void start(const GridHead& head) { all.push_back(head.facts); }
  void other(const std::string& name) { all.emplace_back().name = name; }
  void tile(const TileRecord&) {}
  void leaf() { (void)in.get<LeafRecord>(); }
};

}  // namespace

std::vector<VolumeFacts> check_volumes(const std::string& path, bool fast) {
  std::vector<VolumeFacts> all;
  receive_file(path, fast, [&](Receiver& in) {
    HeadTaker heads{in};
    receive_records(in, heads);
    all = std::move(heads.all);
  });
  return all;
}

}  // namespace vam::io

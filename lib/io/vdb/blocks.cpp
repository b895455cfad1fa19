// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/private/serialisation.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

namespace {

// Passes the voxels of the requested grid to the receiver that begin() names.
class BlockForwarder {
 public:
  BlockForwarder(Receiver& in, const std::function<BlockTaker(const VolumeFacts&)>& begin) : in_(in), begin_(begin) {}

  [[nodiscard]] bool found() const { return found_; }
  [[nodiscard]] const std::string& names() const { return names_; }  // of all grids

  void start(const GridHead& head) {
    found_ = true;
    first_ = {head.first.x(), head.first.y(), head.first.z()};
    background_ = head.facts.background;
    other(head.facts.name);
    take_ = begin_(head.facts);
  }
  void other(const std::string& text) { names_ += (names_.empty() ? "" : ", ") + text; }

  void tile(const TileRecord& tile) const {
    constexpr std::array<int, 3> edges{8, 128, 4096};
    const auto level = static_cast<std::size_t>(tile.level - 1);
    if (tile.value != background_) pass(tile.corner, edges[level], nullptr, tile.value);
  }
  void leaf() {
    in_.get(&leaf_, sizeof leaf_);
    pass(leaf_.corner, 8, leaf_.values.data(), 0);
  }

 private:
  void pass(const std::array<std::int32_t, 3>& corner, int edge, const float* values, float value) const {
    if (take_) take_({corner[0] - first_[0], corner[1] - first_[1], corner[2] - first_[2], edge, values, value});
  }

  Receiver& in_;
  const std::function<BlockTaker(const VolumeFacts&)>& begin_;
  BlockTaker take_;
  LeafRecord leaf_{};
  std::array<int, 3> first_{};
  float background_ = 0;
  std::string names_;
  bool found_ = false;
};

}  // namespace

void read_blocks(const std::string& path, const std::string& name,
                 const std::function<BlockTaker(const VolumeFacts&)>& begin) {
  InputFile file(path);
  openvdb::initialize();
  const WantedGrids wanted{name, false};
  bool found = false;
  std::string names;
  read_apart(
      {file.name(), file.size(), file.descriptor()}, [&](Sender& out) { send_archives(file, wanted, out); },
      [&](Receiver& in) {
        BlockForwarder forwarder(in, begin);
        receive_records(in, forwarder);
        found = forwarder.found();
        names = forwarder.names();
      });
  if (!found) throw Error{Fault::data, file.name() + ": has no grid '" + name + "'; choose one of " + briefly(names)};
}

}  // namespace vam::io

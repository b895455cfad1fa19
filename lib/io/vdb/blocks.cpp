// SPDX-License-Identifier: GPL-3.0-or-later
// Voxels in passing, out of the records of the child that reads archives.
#include <array>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/private/serialisation.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

namespace {

using Begin = std::function<BlockTaker(const VolumeFacts&)>;
using TakeName = std::function<void(const std::string&)>;

// Passes the voxels of each grid to the receiver that begin() names.
struct BlockForwarder {
  Receiver& in;
  const Begin& begin;
  const TakeName& take_other;
  BlockTaker take = {};
  LeafRecord passed = {};
  openvdb::Coord first = {};
  float background = 0;

  void start(const GridHead& head) {
    first = head.first;
    background = head.facts.background;
    take = begin(head.facts);
  }
  void other(const std::string& name) const { take_other(name); }
  void tile(const TileRecord& tile) const {
    constexpr std::array<int, 3> edges{8, 128, 4096};
    if (tile.value != background)
      pass(tile.corner, edges[static_cast<std::size_t>(tile.level - 1)], nullptr, tile.value);
  }
  void leaf() {
    in.get(&passed, sizeof passed);
    pass(passed.corner, 8, passed.values.data(), 0);
  }
  void pass(const std::array<std::int32_t, 3>& corner, int edge, const float* values, float value) const {
    if (take) take({corner[0] - first[0], corner[1] - first[1], corner[2] - first[2], edge, values, value});
  }
};

void pass_blocks(const std::string& path, const WantedGrids& wanted, const Begin& begin, const TakeName& other) {
  InputFile file(path);
  openvdb::initialize();
  read_apart(
      {file.name(), file.size(), file.descriptor()}, [&](Sender& out) { send_archives(file, wanted, out); },
      [&](Receiver& in) {
        BlockForwarder forwarder{in, begin, other};
        receive_records(in, forwarder);
      });
}

}  // namespace

void read_blocks(const std::string& path, const std::string& name, const Begin& begin) {
  bool found = false;
  std::string names;
  const auto begin_it = [&](const VolumeFacts& facts) {
    found = true;
    return begin(facts);
  };
  pass_blocks(path, {name, false}, begin_it,
              [&](const std::string& other) { names += (names.empty() ? "" : ", ") + other; });
  if (found) return;
  throw Error{Fault::data, input_name(path) + ": has no grid '" + name + "'; choose one of " + briefly(names)};
}

std::vector<VolumeFacts> check_volumes(const std::string& path, bool fast) {
  std::vector<VolumeFacts> all;
  const auto add = [&](const VolumeFacts& facts) {
    all.push_back(facts);
    return BlockTaker();
  };
  pass_blocks(path, {std::nullopt, fast}, add, [&](const std::string& other) { all.emplace_back().name = other; });
  return all;
}

}  // namespace vam::io

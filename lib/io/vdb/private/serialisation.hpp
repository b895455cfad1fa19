// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the VDB files: the messages by which the parsing child process returns volumes. Each begins with its
// Record.
// Archives come off a file or a pipe; each head is validated before it is passed to OpenVDB.
#pragma once

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <istream>
#include <memory>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "io/stream/sandboxed_reader.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

enum class Record : std::uint8_t {
  grid,   // a GridHead; its tiles and leaves follow
  other,  // a text: a grid that is not of floats, "velocity (vec3s)"
  tile,   // a TileRecord
  leaf,   // a LeafRecord
  end,
};

struct GridHead {
  VolumeFacts facts;
  std::string unique_name;          // as the archive tells grids of one name apart
  std::string shares;               // the unique name of the grid whose voxels it shares; empty: its own
  openvdb::Coord first;             // index of voxel (0, 0, 0)
  std::array<double, 3> zero_mm{};  // where index (0, 0, 0) lies
};

struct TileRecord {
  std::array<std::int32_t, 3> corner;
  std::int32_t level;  // 1: 8 voxels a side, 2: 128, 3: 4096
  float value;
  std::int32_t active;
};

struct LeafRecord {
  std::array<std::uint64_t, 8> active;
  std::array<std::int32_t, 3> corner;
  std::int32_t padding;  // up to the alignment of the values, so that all bytes sent are set
  std::array<float, 512> values;
};

/// The child's work: sends every archive of the file; heads_alone: of grids of floats in a file, those on a pipe are
/// read to their ends. Throws what for_archives() throws.
void send_archives(InputFile& file, bool heads_alone, Sender& out);
/// The same; `kept` takes what a child must not destroy.
void pass_archives(InputFile& file, bool heads_alone, Sender& out, std::vector<std::shared_ptr<void>>& kept);

inline auto members(GridHead& head) {
  VolumeFacts& facts = head.facts;
  return std::tie(facts.name, facts.grid, facts.background, facts.units, facts.level_set, facts.seal, facts.history,
                  facts.metadata, head.unique_name, head.shares, head.first, head.zero_mm);
}

/// Hands on all records: start(GridHead), other(text), tile(TileRecord) of a level that there is, whatever is sent, and
/// leaf(), which receives the LeafRecord itself.
template <class Taker>
void receive_records(Receiver& in, Taker& taker) {
  while (true) {
    switch (in.get<Record>()) {
      case Record::grid: {
        GridHead head;
        in.fill(members(head));
        taker.start(std::move(head));
        break;
      }
      case Record::other:
        taker.other(in.get<std::string>());
        break;
      case Record::tile: {
        auto tile = in.get<TileRecord>();
        tile.level = std::clamp(tile.level, 1, 3);
        taker.tile(tile);
        break;
      }
      case Record::leaf:
        taker.leaf();
        break;
      case Record::end:
        return;
    }
  }
}

/// Calls `archive` at the start of each archive until the file ends; it must read its archive whole. Throws
/// std::runtime_error, to stand behind the file's name, for what is empty, cut off or not OpenVDB; and what the reader
/// throws.
void for_archives(InputFile& file, const std::function<void(std::istream&)>& archive);

/// Whether an archive begins there.
[[nodiscard]] bool is_archive(std::span<const char> bytes);

/// Walks the head of an archive (file metadata, first grid's descriptor and metadata) as far as `bytes` show it.
/// OpenVDB takes the memory that a size there asks for before it finds that the bytes do not follow.
/// Throws std::runtime_error: not VDB, a format newer than the library's, a size or count that cannot be.
void check_head(std::span<const char> bytes);

}  // namespace vam::io

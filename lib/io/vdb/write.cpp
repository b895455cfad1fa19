// SPDX-License-Identifier: GPL-3.0-or-later
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/text/format_version.hpp"
#include "io/stream/stream.hpp"
#include "io/stream/stream_buffers.hpp"
#include "io/vdb/private/facts.hpp"
#include "io/vdb/private/leaf_store.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

// Archive::write() does the same, but looks at the values of all leaves at once, to tell other programs their sizes
// (which they find without, and newer versions of OpenVDB no longer do).
class ArchiveToWrite : public openvdb::io::Archive {
 public:
  explicit ArchiveToWrite(std::uint32_t compression) { setCompression(compression); }

  void put(std::ostream& stream, const std::vector<SparseVolume>& volumes, bool seekable) {
    openvdb::io::StreamMetadata::Ptr about = std::make_shared<openvdb::io::StreamMetadata>();
    openvdb::io::setStreamMetadataPtr(stream, about, false);
    writeHeader(stream, seekable);
    openvdb::MetaMap().writeMeta(stream);
    const auto count = static_cast<std::int32_t>(volumes.size());
    stream.write(reinterpret_cast<const char*>(&count), sizeof count);
    for (const SparseVolume& volume : volumes) {
      openvdb::io::setDataCompression(stream, compression());
      put(stream, volume.state(), seekable);
    }
    openvdb::io::clearStreamMetadataPtr(stream);
  }

 private:
  void put(std::ostream& stream, const SparseVolume::State& state, bool seekable) {
    FloatGrid& grid = *state.sparse;
    openvdb::io::GridDescriptor about(unique(grid.getName()), grid.type(), false);
    const auto parent = written_.find(&grid.tree());
    if (parent != written_.end()) about.setInstanceParentName(parent->second);
    about.writeHeader(stream);
    const std::streamoff offsets = seekable ? std::streamoff{stream.tellp()} : 0;
    about.writeStreamPos(stream);
    if (seekable) about.setGridPos(stream.tellp());
    setGridCompression(stream, grid);
    with_statistics(grid).writeMeta(stream);
    grid.writeTransform(stream);
    if (parent == written_.end()) {
      grid.writeTopology(stream);
      if (seekable) about.setBlockPos(stream.tellp());
      put_leaves(stream, state);
      written_[&grid.tree()] = about.uniqueName();
    }
    if (!seekable) return;
    about.setEndPos(stream.tellp());
    stream.seekp(offsets, std::ios_base::beg);
    about.writeStreamPos(stream);
    about.seekToEnd(stream);
  }

  // In the order of the tree; stretches of it are compressed side by side.
  static void put_leaves(std::ostream& stream, const SparseVolume::State& state) {
    constexpr std::size_t leaves_together = 8192;
    std::vector<const LeafStore::Leaf*> some;
    for (auto leaf = state.sparse->constTree().cbeginLeaf(); leaf; ++leaf) {
      some.push_back(leaf.getLeaf());
      if (some.size() < leaves_together) continue;
      put_leaves(stream, some, *state.leaves);
      some.clear();
    }
    put_leaves(stream, some, *state.leaves);
  }

  static void put_leaves(std::ostream& stream, std::span<const LeafStore::Leaf* const> some, const LeafStore& leaves) {
    constexpr std::size_t stretch = 256;
    std::vector<std::string> written((some.size() + stretch - 1) / stretch);
    parallel_for(count_of(written), [&](int n) {
      std::ostringstream out;
      out.copyfmt(stream);  // compression and background are kept there
      LeafStore::Values room;
      LeafStore::Leaf whole(Coord(0), 0.0F);
      const std::size_t first = stretch * static_cast<std::size_t>(n);
      for (const LeafStore::Leaf* leaf : some.subspan(first, std::min(stretch, some.size() - first))) {
        whole.setValueMask(leaf->valueMask());
        std::copy_n(leaves.values(*leaf, room), room.size(), whole.buffer().data());
        whole.writeBuffers(out, false);
      }
      written[n] = std::move(out).str();
    });
    for (const std::string& bytes : written) stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

  [[nodiscard]] openvdb::MetaMap with_statistics(FloatGrid& grid) const {
    const openvdb::GridBase::Ptr facts = grid.copy();  // shares the tree
    facts->addStatsMetadata();
    facts->insertMeta(FloatGrid::META_FILE_COMPRESSION,
                      openvdb::StringMetadata(openvdb::io::compressionToString(compression())));
    return *facts;
  }

  std::string unique(const std::string& name) {
    const int before = names_[name]++;
    return name.empty() || before > 0 ? openvdb::io::GridDescriptor::addSuffix(name, before) : name;
  }

  std::map<std::string, int> names_;
  std::map<const openvdb::TreeBase*, std::string> written_;
};

void set_metadata(SparseVolume& volume) {
  FloatGrid& sparse = *volume.state().sparse;
  const model::Grid& grid = volume.grid();
  sparse.clearMetadata();
  for (const auto& [key, value] : volume.metadata) sparse.insertMeta(key, openvdb::StringMetadata(value));
  sparse.setName(volume.name());
  sparse.setGridClass(volume.name() == "sdf" ? openvdb::GRID_LEVEL_SET : openvdb::GRID_FOG_VOLUME);
  std::string history;
  for (const std::string& line : volume.history) history += (history.empty() ? "" : "\n") + line;
  sparse.insertMeta(history_key, openvdb::StringMetadata(history));
  sparse.insertMeta(version_name, openvdb::StringMetadata(FormatKind("volume").version()));
  sparse.insertMeta(units_key, openvdb::StringMetadata(volume.units));
  sparse.insertMeta(shape_key, openvdb::Vec3IMetadata(openvdb::Vec3i(grid.nx, grid.ny, grid.nz)));
  const Coord& first = volume.state().first;
  if (first != Coord(0)) sparse.insertMeta(first_key, openvdb::Vec3IMetadata(first.asVec3i()));
  seal(sparse, *volume.state().leaves);
}

// OpenVDB marks every archive with a random UUID, so that no two runs would give the same bytes. Here it follows from
// what the grids are, seals included (a UUID of version 8: RFC 9562).
constexpr std::uint64_t uuid_offset = 21;  // after magic (8), format (4), library version (8), has-offsets (1)

std::string uuid_of(const std::vector<SparseVolume>& volumes) {
  Sealer all;
  for (const SparseVolume& volume : volumes) {
    const FloatGrid& grid = *volume.state().sparse;
    for (auto it = grid.beginMeta(); it != grid.endMeta(); ++it) {
      all.add(it->first);
      all.add(it->second->str());
    }
  }
  const Digest hash = all.digest();
  char text[40];
  std::snprintf(text, sizeof text, "%08x-%04x-8%03x-8%03x-%012llx", static_cast<unsigned>(hash.high >> 32),
                static_cast<unsigned>(hash.high >> 16 & 0xffff), static_cast<unsigned>(hash.high & 0xfff),
                static_cast<unsigned>(hash.low >> 52), static_cast<unsigned long long>(hash.low & 0xffffffffffffULL));
  return text;
}

}  // namespace

void write_volumes(const std::string& path, std::vector<SparseVolume>& volumes) {
  openvdb::initialize();
  OutputFile file(path);
  const std::uint32_t blosc = file.is_stream() ? openvdb::io::COMPRESS_NONE : openvdb::io::COMPRESS_BLOSC;
  const std::uint32_t compression = openvdb::io::COMPRESS_ACTIVE_MASK | blosc;
  for (SparseVolume& volume : volumes) {
    volume.prune();
    set_metadata(volume);
  }
  OutputBuffer buffer(file);
  buffer.replace(uuid_offset, uuid_of(volumes));
  std::ostream stream(&buffer);
  stream.exceptions(std::ios_base::badbit | std::ios_base::failbit);
  ArchiveToWrite(compression).put(stream, volumes, !file.is_stream());
  stream.flush();
  file.commit();
}

void write_volume(const std::string& path, SparseVolume& volume) {
  std::vector<SparseVolume> one;
  one.push_back(std::move(volume));
  write_volumes(path, one);
  volume = std::move(one.front());
}

}  // namespace vam::io

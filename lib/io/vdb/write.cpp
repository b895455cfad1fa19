#include <openvdb/io/Stream.h>
#include <openvdb/tree/NodeManager.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <stdexcept>

#include "base/error.hpp"
#include "io/stream/finite.hpp"
#include "io/stream/stream.hpp"
#include "io/stream/stream_buffers.hpp"
#include "io/vdb/private/archive.hpp"
#include "io/vdb/private/facts.hpp"
#include "io/vdb/private/grid.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

// ---- reading ----------------------------------------------------------------------------------------------------

// Every value of a tree, in tiles and leaves; called in parallel.
struct FiniteCheck {
  std::atomic<bool>& finite;

  template <class Node>
  bool operator()(const Node& node, std::size_t) const {
    for (auto tile = node.cbeginValueAll(); tile; ++tile) {
      if (!std::isfinite(*tile)) finite = false;
    }
    return finite;
  }
  bool operator()(const FloatGrid::TreeType::LeafNodeType& leaf, std::size_t) const {
    if (!all_finite(leaf.buffer().data(), leaf.SIZE)) finite = false;
    return finite;
  }
};

void check_finite(const FloatGrid& grid) {
  std::atomic<bool> finite{std::isfinite(grid.background())};
  openvdb::tree::DynamicNodeManager<const FloatGrid::TreeType> nodes(grid.constTree());
  nodes.foreachTopDown(FiniteCheck{finite});
  if (!finite) throw std::runtime_error("grid '" + grid.getName() + "' has a value that is not a finite number");
}

SparseVolume volume_of(const FloatGrid::Ptr& sparse) {
  Coord first;
  VolumeFacts facts = facts_of(*sparse, first);
  check_finite(*sparse);
  SparseVolume volume(facts.name, facts.grid, facts.background);
  volume.state().sparse = sparse;
  volume.state().first = first;
  volume.history = std::move(facts.history);
  volume.units = std::move(facts.units);
  volume.metadata = std::move(facts.metadata);
  return volume;
}

// ---- writing ----------------------------------------------------------------------------------------------------

// Archive::write is what io::File and io::Stream both call; those two do not notice a full disk, or cannot seek.
struct Archive : openvdb::io::Archive {
  void put(std::ostream& stream, const openvdb::GridCPtrVec& grids, bool seekable) const {
    write(stream, grids, seekable);
  }
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
  sparse.insertMeta(units_key, openvdb::StringMetadata(volume.units));
  sparse.insertMeta(shape_key, openvdb::Vec3IMetadata(openvdb::Vec3i(grid.nx, grid.ny, grid.nz)));
  const Coord& first = volume.state().first;
  if (first != Coord(0)) sparse.insertMeta(first_key, openvdb::Vec3IMetadata(first.asVec3i()));
}

// OpenVDB marks every archive with a random UUID, so that no two runs would give the same bytes. Here it follows from
// what the grids are (FNV-1a, as a UUID of version 8: RFC 9562).
constexpr std::uint64_t uuid_offset = 21;  // after magic (8), format (4), library version (8), has-offsets (1)

std::string uuid_of(const openvdb::GridCPtrVec& grids) {
  std::ostringstream facts;
  for (const auto& grid : grids) {
    facts << grid->activeVoxelCount() << ' ' << grid->baseTree().leafCount() << ' ' << grid->transform();
    for (auto it = grid->beginMeta(); it != grid->endMeta(); ++it)
      facts << it->first << ' ' << it->second->str() << ' ';
  }
  std::array<std::uint64_t, 2> hash = {14695981039346656037ULL, 14695981039346656037ULL ^ 0x5bd1e995ULL};
  for (const char byte : facts.str()) {
    for (auto& half : hash) half = (half ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  }
  char text[40];
  std::snprintf(text, sizeof text, "%08x-%04x-8%03x-8%03x-%012llx", static_cast<unsigned>(hash[0] >> 32),
                static_cast<unsigned>(hash[0] >> 16 & 0xffff), static_cast<unsigned>(hash[0] & 0xfff),
                static_cast<unsigned>(hash[1] >> 52), static_cast<unsigned long long>(hash[1] & 0xffffffffffffULL));
  return text;
}

}  // namespace

std::vector<SparseVolume> read_volumes(const std::string& path) {
  InputFile file(path);
  std::vector<SparseVolume> volumes;
  std::string others;
  for_archives(file, [&](std::istream& stream) {
    openvdb::io::Stream archive(stream, false);  // delayed loading would copy stdin to a temporary file
    const auto grids = archive.getGrids();
    for (const auto& grid : *grids) {
      if (const auto sparse = openvdb::gridPtrCast<FloatGrid>(grid)) {
        volumes.push_back(volume_of(sparse));
      } else {
        others += " " + grid->getName() + " (" + grid->valueType() + ")";
      }
    }
  });
  if (volumes.empty()) {
    throw Error{Fault::data,
                file.name() + ": holds no grid of floats" + (others.empty() ? std::string() : ", but" + others)};
  }
  return volumes;
}

SparseVolume read_volume(const std::string& path, const std::string& name) {
  std::vector<SparseVolume> volumes = read_volumes(path);
  std::string names;
  for (SparseVolume& volume : volumes) {
    if (volume.name() == name || (name.empty() && volumes.size() == 1)) return std::move(volume);
    names += (names.empty() ? "" : ", ") + volume.name();
  }
  const std::string subject = path == "-" ? "stdin" : path;
  if (name.empty()) throw Error{Fault::data, subject + ": holds several grids (" + names + "); choose one by name"};
  throw Error{Fault::data, subject + ": has no grid '" + name + "', but " + names};
}

void write_volumes(const std::string& path, std::vector<SparseVolume>& volumes) {
  openvdb::initialize();
  OutputFile file(path);
  openvdb::GridCPtrVec grids;
  for (SparseVolume& volume : volumes) {
    volume.prune();
    set_metadata(volume);
    grids.push_back(volume.state().sparse);
  }
  OutputBuffer buffer(file);
  buffer.replace(uuid_offset, uuid_of(grids));
  std::ostream stream(&buffer);
  stream.exceptions(std::ios_base::badbit | std::ios_base::failbit);
  Archive archive;
  const std::uint32_t blosc = file.is_stream() ? openvdb::io::COMPRESS_NONE : openvdb::io::COMPRESS_BLOSC;
  archive.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK | blosc);
  archive.put(stream, grids, !file.is_stream());
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

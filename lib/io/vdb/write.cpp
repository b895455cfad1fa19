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
#include "io/vdb/private/seals.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

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
  seal(sparse);
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

#include <openvdb/io/Stream.h>
#include <openvdb/tools/Count.h>
#include <openvdb/tree/NodeManager.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "base/error.hpp"
#include "io/finite.hpp"
#include "io/stream.hpp"
#include "io/stream_buffers.hpp"
#include "io/vdb.hpp"
#include "io/vdb_grid.hpp"
#include "io/vdb_head.hpp"

namespace vam::io {

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;

// Refused beyond these, before dense memory is taken.
constexpr int max_side = 1 << 15;                          // voxels
constexpr std::int64_t max_slice = std::int64_t{1} << 28;  // voxels: 1 GiB as float

constexpr const char* history_key = "vam:history";
constexpr const char* units_key = "vam:units";
constexpr const char* shape_key = "vam:shape";  // voxels along x, y, z: the box that was asked for, padding included
constexpr const char* first_key = "vam:first_index";  // of that box, where it is not 0

// Grid and metadata types must be registered once before anything is read.
void initialize_library() {
  static const bool done = [] {
    openvdb::initialize();
    return true;
  }();
  (void)done;
}

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

// A uniform scale along the axes, and a shift: the only transform that a stack of square pixels can follow.
void set_transform(const FloatGrid& sparse, const Coord& first, model::Grid& grid) {
  const std::string name = "grid '" + sparse.getName() + "'";
  if (!sparse.transform().isLinear()) throw std::runtime_error(name + " has a transform that is not linear");
  const openvdb::Mat4d matrix = sparse.transform().baseMap()->getAffineMap()->getMat4();
  const double voxel = matrix(0, 0);
  if (!(voxel > 0) || !std::isfinite(voxel)) throw std::runtime_error(name + " is rotated or mirrored");
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const double wanted = row == column ? voxel : 0.0;
      // Transforms are stored as double, but other programs compute theirs as float.
      if (std::abs(matrix(row, column) - wanted) <= 1e-6 * voxel) continue;
      throw std::runtime_error(name + " has a rotated, mirrored or non-uniform transform; resample it first");
    }
  }
  const openvdb::Vec3d origin = sparse.indexToWorld(first);
  grid.voxel_mm = sparse.voxelSize().x();  // as it was written, to the last bit
  grid.origin_mm = {origin.x(), origin.y(), origin.z()};
  if (!std::isfinite(origin.lengthSqr())) throw std::runtime_error(name + " lies at infinity");
}

// The box written by these tools, widened where another program has added voxels beyond it; else the active box.
CoordBBox box_of(const FloatGrid& sparse) {
  CoordBBox box = sparse.evalActiveVoxelBoundingBox();
  if (const auto shape = sparse.getMetadata<openvdb::Vec3IMetadata>(shape_key)) {
    const openvdb::Vec3i size = shape->value();
    const auto origin = sparse.getMetadata<openvdb::Vec3IMetadata>(first_key);
    const Coord first = origin ? Coord(origin->value()) : Coord(0);
    bool sane = true;
    for (int axis = 0; axis < 3; ++axis) {
      sane = sane && size[axis] >= 1 && size[axis] <= max_side && std::abs(first[axis]) < (1 << 30);
    }
    if (!sane) throw std::runtime_error("grid '" + sparse.getName() + "' has an impossible vam:shape");
    box.expand(CoordBBox(first, first + Coord(size) - Coord(1)));
  }
  if (box.empty()) throw std::runtime_error("grid '" + sparse.getName() + "' is empty");
  const auto side = [&box](int axis) { return std::int64_t{box.max()[axis]} - box.min()[axis] + 1; };
  if (side(0) > max_side || side(1) > max_side || side(2) > max_side || side(0) * side(1) > max_slice) {
    throw std::runtime_error("grid '" + sparse.getName() + "' spans " + std::to_string(side(0)) + " x " +
                             std::to_string(side(1)) + " x " + std::to_string(side(2)) +
                             " voxels; up to 32768 a side and 2^28 a slice can be read");
  }
  return box;
}

bool is_written_by_library(const std::string& key) {
  static const std::array keys = {FloatGrid::META_GRID_NAME, FloatGrid::META_GRID_CLASS, FloatGrid::META_GRID_CREATOR,
                                  FloatGrid::META_VECTOR_TYPE};
  return key.starts_with("file_") || std::find(keys.begin(), keys.end(), key) != keys.end();
}

void take_metadata(const FloatGrid& sparse, SparseVolume& volume) {
  for (auto it = sparse.beginMeta(); it != sparse.endMeta(); ++it) {
    if (it->second->typeName() != openvdb::StringMetadata::staticTypeName()) continue;
    const std::string value = it->second->str();
    if (it->first == history_key) {
      std::istringstream lines(value);
      for (std::string line; std::getline(lines, line);) volume.history.push_back(line);
    } else if (it->first == units_key) {
      volume.units = value;
    } else if (!is_written_by_library(it->first)) {
      volume.metadata[it->first] = value;
    }
  }
}

SparseVolume volume_of(const FloatGrid::Ptr& sparse) {
  const CoordBBox box = box_of(*sparse);
  model::Grid grid{box.dim().x(), box.dim().y(), box.dim().z(), 1.0, {}};
  set_transform(*sparse, box.min(), grid);
  check_finite(*sparse);
  SparseVolume volume(sparse->getName(), grid, sparse->background());
  volume.state().sparse = sparse;
  volume.state().first = box.min();
  take_metadata(*sparse, volume);
  return volume;
}

// OpenVDB comments on std::cerr on what it meets in a damaged file; one line is enough, and it will be ours.
struct Quiet {
  Quiet() : saved(std::cerr.rdbuf(nullptr)) {}
  ~Quiet() {
    std::cerr.rdbuf(saved);
    std::cerr.clear();
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  std::streambuf* saved;
};

void read_archive(InputFile& file, std::vector<SparseVolume>& volumes, std::string& others) {
  check_head(file.peek());
  const Quiet quiet;
  InputBuffer buffer(file);
  std::istream stream(&buffer);
  stream.exceptions(std::ios_base::badbit | std::ios_base::failbit);
  openvdb::io::Stream archive(stream, false);  // delayed loading would copy stdin to a temporary file
  const auto grids = archive.getGrids();
  for (const auto& grid : *grids) {
    if (const auto sparse = openvdb::gridPtrCast<FloatGrid>(grid)) {
      volumes.push_back(volume_of(sparse));
    } else {
      others += " " + grid->getName() + " (" + grid->valueType() + ")";
    }
  }
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
  initialize_library();
  InputFile file(path);
  std::vector<SparseVolume> volumes;
  std::string others;
  try {
    if (file.at_end()) throw std::runtime_error("is empty; the program that should have written it failed");
    while (!file.at_end()) read_archive(file, volumes, others);
    if (volumes.empty()) {
      throw std::runtime_error("holds no grid of floats" + (others.empty() ? std::string() : ", but" + others));
    }
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    // One absurd request, that is: a volume that is merely too large is killed by the system when memory runs out.
    throw Error{Fault::data, file.name() + ": asks for more memory than there is; it is damaged"};
  } catch (const std::ios_base::failure&) {
    throw Error{Fault::data, file.name() + ": is cut off after " + std::to_string(file.position()) +
                                 " bytes; the program that wrote it did not finish"};
  } catch (const std::exception& problem) {
    std::string line = file.name() + ": " + problem.what();
    std::replace(line.begin(), line.end(), '\n', ' ');
    throw Error{Fault::data, line};
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
  initialize_library();
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

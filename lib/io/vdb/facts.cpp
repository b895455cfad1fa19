// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vdb/private/facts.hpp"

#include <openvdb/tools/Count.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>

#include "base/index.hpp"
#include "base/text/format_version.hpp"
#include "model/metadata.hpp"

namespace vam::io {

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;

// Refused beyond these, before dense memory is taken.
constexpr int max_side = 1 << 16;                          // voxels
constexpr double max_void = 8192;                          // voxels a side that are added around a part
constexpr std::int64_t max_slice = std::int64_t{1} << 28;  // voxels: 1 GiB as float

// A uniform scale along the axes, and a shift: the only transform that a stack of square pixels can follow.
void set_transform(const FloatGrid& sparse, const Coord& first, model::Grid& grid) {
  const std::string name = "grid " + excerpt(sparse.getName());
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
  grid.voxel_mm = voxel;  // not the map's voxelSize(), which files hold once more and no seal covers
  grid.origin_mm = {origin.x(), origin.y(), origin.z()};
  if (!std::isfinite(origin.lengthSqr())) throw std::runtime_error(name + " lies at infinity");
}

void require_integers(const FloatGrid& sparse, const char* key) {
  for (auto it = sparse.beginMeta(); it != sparse.endMeta(); ++it) {
    if (it->first != key || it->second->typeName() == openvdb::Vec3IMetadata::staticTypeName()) continue;
    throw std::runtime_error("grid " + excerpt(sparse.getName()) + " has " + key + " as " + it->second->typeName() +
                             ", not as three integers (vec3i); mend it in the program that wrote it");
  }
}

// The box written by these tools, widened where another program has added voxels beyond it; else the active box.
CoordBBox box_of(const FloatGrid& sparse) {
  CoordBBox box = sparse.evalActiveVoxelBoundingBox();
  for (const char* key : {shape_key, first_key}) require_integers(sparse, key);
  if (const auto shape = sparse.getMetadata<openvdb::Vec3IMetadata>(shape_key)) {
    const openvdb::Vec3i size = shape->value();
    const auto origin = sparse.getMetadata<openvdb::Vec3IMetadata>(first_key);
    const openvdb::Vec3i first = origin ? origin->value() : openvdb::Vec3i(0);
    bool sane = true;
    for (int axis = 0; axis < 3; ++axis) {
      sane = sane && size[axis] >= 1 && size[axis] <= max_side && std::abs(first[axis]) < (1 << 30);
    }
    if (!sane) throw std::runtime_error("grid " + excerpt(sparse.getName()) + " has an impossible vam:shape");
    box.expand(CoordBBox(Coord(first), Coord(first + size) - Coord(1)));
  }
  if (box.empty()) throw std::runtime_error("grid " + excerpt(sparse.getName()) + " is empty");
  const auto side = [low = box.min().asVec3i(), high = box.max().asVec3i()](int axis) {
    return std::int64_t{high[axis]} - low[axis] + 1;
  };
  if (side(0) > max_side || side(1) > max_side || side(2) > max_side || side(0) * side(1) > max_slice) {
    throw std::runtime_error("grid " + excerpt(sparse.getName()) + " spans " + std::to_string(side(0)) + " x " +
                             std::to_string(side(1)) + " x " + std::to_string(side(2)) +
                             " voxels; up to 65536 per axis and 2^28 a slice can be read");
  }
  return box;
}

bool is_of_part(const std::string& name) {
  return name == "target" || name == "insert" || name == "weight" || name == "tolerance";
}

// A target of another program has the box of its voxels, which ends at the part: it gets the void around the part, out
// to the circle about the axis that holds the box.
CoordBBox with_void(CoordBBox box, const model::Grid& grid) {
  const double low_x = grid.x_mm(-0.5);
  const double low_y = grid.y_mm(-0.5);
  const double high_x = grid.x_mm(grid.nx - 0.5);
  const double high_y = grid.y_mm(grid.ny - 0.5);
  const double reach_mm =
      std::hypot(std::max(std::abs(low_x), std::abs(high_x)), std::max(std::abs(low_y), std::abs(high_y)));
  if (2 * reach_mm > max_void * grid.voxel_mm) return box;  // nowhere near the axis
  const auto voxels = [&](double mm) { return ceil_int(mm / grid.voxel_mm); };
  box.min() -= Coord(voxels(low_x + reach_mm), voxels(low_y + reach_mm), 0);
  box.max() += Coord(voxels(reach_mm - high_x), voxels(reach_mm - high_y), 0);
  return box;
}

void set_box(const CoordBBox& box, model::Grid& grid, Coord& first) {
  grid = {box.dim().x(), box.dim().y(), box.dim().z(), 1.0, {}};
  first = box.min();
}

bool is_written_anew(const std::string& key) {
  static const std::array keys = {FloatGrid::META_GRID_NAME, FloatGrid::META_GRID_CLASS, FloatGrid::META_GRID_CREATOR,
                                  FloatGrid::META_VECTOR_TYPE};
  return key.starts_with("file_") || is_seal_key(key) || key == version_name ||
         std::find(keys.begin(), keys.end(), key) != keys.end();
}

void require_stretch(const FloatGrid& sparse, const openvdb::Metadata& stated) {
  const bool is_text = stated.typeName() == openvdb::StringMetadata::staticTypeName();
  const std::string why = is_text ? model::stretch_objection(stated.str())
                                  : std::string("states ") + model::stretch_name + " as " + stated.typeName() +
                                        ", not as text; slice it again";
  if (!why.empty()) throw std::runtime_error("grid " + excerpt(sparse.getName()) + " " + why);
}

void take_metadata(const FloatGrid& sparse, VolumeFacts& facts) {
  for (auto it = sparse.beginMeta(); it != sparse.endMeta(); ++it) {
    if (it->first == model::stretch_name) require_stretch(sparse, *it->second);
    if (it->second->typeName() != openvdb::StringMetadata::staticTypeName()) continue;
    const std::string value = it->second->str();
    if (it->first == history_key) {
      constexpr std::size_t most_bytes = 1 << 20;
      if (value.size() > most_bytes) throw std::runtime_error("has a history of more than 1 MiB");
      std::istringstream lines(value);
      for (std::string line; std::getline(lines, line);) facts.history.push_back(line);
    } else if (it->first == units_key) {
      facts.units = value;
    } else if (!is_written_anew(it->first)) {
      facts.metadata[it->first] = value;
    }
  }
}

}  // namespace

VolumeFacts head_of(const FloatGrid& sparse) {
  VolumeFacts facts;
  facts.name = sparse.getName();
  facts.level_set = sparse.getGridClass() == openvdb::GRID_LEVEL_SET;
  take_metadata(sparse, facts);
  return facts;
}

VolumeFacts facts_of(const FloatGrid& sparse, Coord& first) {
  const CoordBBox box = box_of(sparse);
  VolumeFacts facts = head_of(sparse);
  facts.background = sparse.background();
  set_box(box, facts.grid, first);
  set_transform(sparse, first, facts.grid);
  if (is_of_part(facts.name) && !sparse.getMetadata<openvdb::Vec3IMetadata>(shape_key)) {
    set_box(with_void(box, facts.grid), facts.grid, first);
    set_transform(sparse, first, facts.grid);
  }
  return facts;
}

}  // namespace vam::io

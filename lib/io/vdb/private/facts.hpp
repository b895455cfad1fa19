// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the VDB files: a grid's facts beside its voxels.
#pragma once

#include <openvdb/openvdb.h>

#include <string>

#include "base/text/printable.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

inline constexpr const char* history_key = "vam:history";
inline constexpr const char* units_key = "vam:units";
inline constexpr const char* shape_key = "vam:shape";  // voxels along x, y, z: the requested box, padding included
inline constexpr const char* first_key = "vam:first_index";  // of that box, where it is not 0

/// Name, box, place and metadata of a grid whose topology has been read; its voxels need not be. `first` becomes the
/// index of voxel (0, 0, 0). Throws std::runtime_error: a transform that is not uniform along the axes, an impossible
/// or empty box.
[[nodiscard]] VolumeFacts facts_of(const openvdb::FloatGrid& sparse, openvdb::Coord& first);

/// Of these what stands before the topology: name, class and metadata.
[[nodiscard]] VolumeFacts head_of(const openvdb::FloatGrid& sparse);

/// The error of a name that two grids of a file have.
[[nodiscard]] inline std::string occurs_twice(const std::string& name) {
  return "grid " + excerpt(name) + " occurs twice; keep one of them, or rename it";
}

}  // namespace vam::io

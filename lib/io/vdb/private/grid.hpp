// Private to the VDB files: the OpenVDB grid behind a SparseVolume.
#pragma once

#include <openvdb/openvdb.h>

#include <string>

#include "io/vdb/vdb.hpp"

namespace vam::io {

struct SparseVolume::State {
  std::string name;
  model::Grid grid;
  openvdb::FloatGrid::Ptr sparse;
  openvdb::Coord first;  // index of voxel (0, 0, 0) in `sparse`; not 0 in files of other programs
};

}  // namespace vam::io

// SPDX-License-Identifier: GPL-3.0-or-later
// Private to the VDB files: the OpenVDB grid behind a SparseVolume.
#pragma once

#include <openvdb/openvdb.h>

#include <memory>
#include <string>

#include "io/vdb/private/leaf_store.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

struct SparseVolume::State {
  std::string name;
  model::Grid grid;
  openvdb::FloatGrid::Ptr sparse;
  std::shared_ptr<LeafStore> leaves = std::make_shared<LeafStore>();  // of the tree, which grids may share
  openvdb::Coord first;  // index of voxel (0, 0, 0) in `sparse`; not 0 in files of other programs
};

}  // namespace vam::io

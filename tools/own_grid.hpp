// SPDX-License-Identifier: GPL-3.0-or-later
// A grid that has a file of its own, or one beside others.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "io/vdb/gate.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::tool {

/// The grid of that name, or the only one. Throws Fault::data where there is none.
inline io::SparseVolume read_own(const std::string& path, const std::string& name) {
  std::vector<io::SparseVolume> volumes = io::read_volumes(path);
  io::require_usable(path, volumes);
  for (io::SparseVolume& volume : volumes) {
    if (volume.name() == name || volumes.size() == 1) return std::move(volume);
  }
  throw Error{Fault::data, path + ": has several grids, but none is called '" + name + "'"};
}

/// Of a grid that must lie on that of the target. file: begins the message.
inline Error differs_from_target(const io::SparseVolume& volume, const std::string& file) {
  return {Fault::data, file + ": the grid of '" + volume.name() +
                           "' differs from that of the target; make both from the same target"};
}

}  // namespace vam::tool

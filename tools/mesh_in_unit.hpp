// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh whose unit may be said on the command line.
#pragma once

#include <string>
#include <utility>

#include "base/error.hpp"
#include "io/mesh/file.hpp"
#include "io/stream/input_name.hpp"

namespace vam::tool {

/// Throws Fault::usage where `flag` is given for a file that states its unit, by which that of the command line would
/// be multiplied; `scale` is the option to change the size.
inline model::TriangleSoup mesh_in_unit(const std::string& path, bool given, const std::string& flag,
                                        const std::string& scale) {
  io::ColouredMesh read = io::read_coloured_mesh(path);
  if (given && read.in_mm) {
    throw Error{Fault::usage, flag + ": " + io::input_name(path) + " states its unit, as 3MF files do; omit " + flag +
                                  ", or give " + scale + " to change the size"};
  }
  return std::move(read.mesh);
}

}  // namespace vam::tool

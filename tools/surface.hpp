// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of a body: of a mesh, or where a volume has a value.
#pragma once

#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/text.hpp"
#include "facts.hpp"
#include "io/mesh/file.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/input_name.hpp"
#include "io/vdb/gate.hpp"
#include "io/vdb/vdb.hpp"
#include "solid/voxel/isosurface.hpp"

namespace vam::tool {

/// Throws Fault::usage without an isovalue, otherwise as io::read_volume() and io::require_usable(): a target whose
/// surface is beyond 1 is grey.
inline io::SparseVolume open_body(const std::string& path, std::optional<double> isovalue) {
  if (!isovalue) {
    throw Error{Fault::usage,
                io::input_name(path) + ": is a volume; give the isovalue of its surface by --isovalue or --resin"};
  }
  io::SparseVolume body = io::read_volume(path, "");
  io::require_usable(path, body, *isovalue > 1 ? io::TargetKind::grey : io::TargetKind::coverage);
  return body;
}

/// Throws Fault::data where the volume does not cross it.
inline model::TriangleSoup surface_of(const std::string& path, const model::Volume& volume, double isovalue) {
  model::TriangleSoup mesh = solid::isosurface(volume, isovalue);
  if (!mesh.triangles.empty()) return mesh;
  throw Error{Fault::data, io::input_name(path) + ": no surface, the volume does not cross " + format_number(isovalue)};
}

/// In mm of the part, whose stretch is undone. Throws Error: usage, no_input, data.
inline model::TriangleSoup read_surface(const std::string& path, std::optional<double> isovalue) {
  if (!io::is_volume(path)) return io::read_mesh(path);
  const io::SparseVolume sparse = open_body(path, isovalue);
  model::TriangleSoup mesh = surface_of(path, io::dense_volume(sparse), *isovalue);
  unstretch(mesh, sparse.metadata);
  return mesh;
}

}  // namespace vam::tool

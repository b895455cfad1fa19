// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/surface.hpp"

#include <utility>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "io/mesh/file.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/gate.hpp"
#include "solid/voxel/isosurface.hpp"

namespace vam::session {

model::TriangleSoup mesh_in_unit(const std::string& path, bool given, const std::string& flag,
                                 const std::string& scale) {
  io::ColouredMesh read = io::read_coloured_mesh(path);
  if (given && read.in_mm) {
    throw Error{Fault::usage, flag + ": " + io::input_name(path) + " states its unit, as 3MF files do; omit " + flag +
                                  ", or give " + scale + " to change the size"};
  }
  return std::move(read.mesh);
}

model::TriangleSoup read_surface(const std::string& path, std::optional<double> isovalue,
                                 const std::function<void(model::Volume&)>& prepare, const MeasureSurface& measure) {
  if (!io::is_volume(path)) return io::read_mesh(path);
  const std::string name = io::input_name(path);
  if (!isovalue) {
    throw Error{Fault::usage, name + ": is a volume; give the isovalue of its surface by --isovalue or --resin"};
  }
  const io::SparseVolume sparse = io::read_volume(path, "");
  io::require_usable(path, sparse, *isovalue > 1 ? io::TargetKind::grey : io::TargetKind::coverage);
  model::Volume volume = io::dense_volume(sparse);
  if (prepare) prepare(volume);
  model::TriangleSoup mesh = solid::isosurface(volume, *isovalue);
  if (mesh.triangles.empty()) {
    throw Error{Fault::data, name + ": no surface, the volume does not cross " + format_number(*isovalue)};
  }
  if (measure) measure(volume, mesh);
  model::unstretch(mesh, sparse.metadata);
  return mesh;
}

model::TriangleSoup fine_surface(const io::SparseVolume& volume, double level, const model::Metadata& stretched) {
  model::TriangleSoup mesh = solid::fine_isosurface(
      volume.grid(), [&](int k, int count, float* out) { volume.read_slices(k, count, out); }, level);
  model::unstretch(mesh, stretched);
  return mesh;
}

}  // namespace vam::session

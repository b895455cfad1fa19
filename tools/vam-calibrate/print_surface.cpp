// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.hpp"
#include "io/mesh/file.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/input_name.hpp"
#include "metrology/cure/bodies.hpp"
#include "model/metadata.hpp"
#include "session/surface.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

model::TriangleSoup print_surface(const std::string& path, std::optional<double> isovalue) {
  if (!io::is_volume(path)) return io::read_mesh(path);
  const io::SparseVolume sparse = session::open_body(path, isovalue);
  model::Volume volume = io::dense_volume(sparse);
  (void)metrology::keep_bodies(volume, *isovalue, {});
  model::TriangleSoup mesh = session::surface_of(path, volume, *isovalue);
  model::unstretch(mesh, sparse.metadata);
  return mesh;
}

}  // namespace vam::calibrate_tool

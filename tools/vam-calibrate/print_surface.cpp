// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.hpp"
#include "io/stream/input_name.hpp"
#include "metrology/cure/bodies.hpp"
#include "surface.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

model::TriangleSoup print_surface(const std::string& path, std::optional<double> isovalue) {
  if (!io::is_volume(path)) return io::read_mesh(path);
  const io::SparseVolume sparse = tool::open_body(path, isovalue);
  model::Volume volume = io::dense_volume(sparse);
  (void)metrology::keep_bodies(volume, *isovalue, {});
  model::TriangleSoup mesh = tool::surface_of(path, volume, *isovalue);
  tool::unstretch(mesh, sparse.metadata);
  return mesh;
}

}  // namespace vam::calibrate_tool

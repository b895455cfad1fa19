#include <functional>

#include "base/error.hpp"
#include "base/text.hpp"
#include "facts.hpp"
#include "io/mesh/file.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/input_name.hpp"
#include "io/vdb/vdb.hpp"
#include "solid/voxel/isosurface.hpp"
#include "vam-sdf/options.hpp"

namespace vam::sdf_tool {

namespace {

model::TriangleSoup surface_of(const std::string& path, std::optional<double> isovalue,
                               const std::function<void(model::Volume&, double)>& prepare) {
  if (!io::is_volume(path)) return io::read_mesh(path);
  const std::string name = io::input_name(path);
  if (!isovalue)
    throw Error{Fault::usage, name + ": is a volume; give the isovalue of its surface by --isovalue or --resin"};
  const io::SparseVolume sparse = io::read_volume(path, "");
  model::Volume volume{sparse.grid(), std::vector<float>(sparse.grid().size())};
  sparse.read_slices(0, volume.grid.nz, volume.values.data());
  prepare(volume, *isovalue);
  model::TriangleSoup mesh = solid::isosurface(volume, *isovalue);
  if (mesh.triangles.empty()) {
    throw Error{Fault::data, name + ": no surface, the volume does not cross " + format_number(*isovalue)};
  }
  tool::unstretch(mesh, sparse.metadata);
  return mesh;
}

}  // namespace

model::TriangleSoup read_surface(const std::string& path, std::optional<double> isovalue) {
  return surface_of(path, isovalue, [](model::Volume&, double) {});
}

model::TriangleSoup read_print(const std::string& path, std::optional<double> isovalue, std::optional<double> least_mm3,
                               std::optional<metrology::BodyCount>& bodies) {
  return surface_of(path, isovalue, [&](model::Volume& volume, double level) {
    bodies = metrology::keep_bodies(volume, level, {least_mm3, {}});
  });
}

}  // namespace vam::sdf_tool

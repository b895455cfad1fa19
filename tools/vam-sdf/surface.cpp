#include "base/error.hpp"
#include "base/text.hpp"
#include "io/mesh/file.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/input_name.hpp"
#include "io/vdb/vdb.hpp"
#include "solid/voxel/isosurface.hpp"
#include "vam-sdf/options.hpp"

namespace vam::sdf_tool {

model::TriangleSoup read_surface(const std::string& path, std::optional<double> isovalue) {
  if (!io::is_volume(path)) return io::read_mesh(path);
  const std::string name = io::input_name(path);
  if (!isovalue)
    throw Error{Fault::usage, name + ": is a volume; give the isovalue of its surface by --isovalue or --resin"};
  const io::SparseVolume volume = io::read_volume(path, "");
  model::TriangleSoup mesh = solid::isosurface(
      volume.grid(), [&](int k, int count, float* out) { volume.read_slices(k, count, out); }, *isovalue);
  if (mesh.triangles.empty()) {
    throw Error{Fault::data, name + ": no surface, the volume does not cross " + format_number(*isovalue)};
  }
  const auto stretch = volume.metadata.find("vam:stretch_z");
  const double factor = stretch == volume.metadata.end() ? 1.0 : parse_number(stretch->second).value_or(1.0);
  for (auto& point : mesh.points) point[2] /= factor;
  return mesh;
}

}  // namespace vam::sdf_tool

// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.hpp"
#include "base/stats/median.hpp"
#include "base/text.hpp"
#include "facts.hpp"
#include "io/mesh/file.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/input_name.hpp"
#include "io/vdb/vdb.hpp"
#include "metrology/ost/surface_uncertainty.hpp"
#include "solid/voxel/isosurface.hpp"
#include "vam-sdf/options.hpp"

namespace vam::sdf_tool {

namespace {

io::SparseVolume open_volume(const std::string& path, std::optional<double> isovalue) {
  if (!isovalue) {
    throw Error{Fault::usage,
                io::input_name(path) + ": is a volume; give the isovalue of its surface by --isovalue or --resin"};
  }
  return io::read_volume(path, "");
}

model::TriangleSoup surface_of(const std::string& path, const model::Volume& volume, double isovalue) {
  model::TriangleSoup mesh = solid::isosurface(volume, isovalue);
  if (!mesh.triangles.empty()) return mesh;
  throw Error{Fault::data, io::input_name(path) + ": no surface, the volume does not cross " + format_number(isovalue)};
}

}  // namespace

model::TriangleSoup read_surface(const std::string& path, std::optional<double> isovalue) {
  if (!io::is_volume(path)) return io::read_mesh(path);
  const io::SparseVolume sparse = open_volume(path, isovalue);
  model::TriangleSoup mesh = surface_of(path, io::dense_volume(sparse), *isovalue);
  tool::unstretch(mesh, sparse.metadata);
  return mesh;
}

PrintSurface read_print(const Options& options, std::optional<double> isovalue) {
  PrintSurface print;
  if (!io::is_volume(options.print)) {
    if (!options.uncertainty.empty() || options.isovalue_uncertainty > 0) {
      throw Error{Fault::usage,
                  options.print + ": is a mesh; --uncertainty and --isovalue-uncertainty need the volume"};
    }
    io::ColouredMesh read = io::read_coloured_mesh(options.print);
    print.mesh = std::move(read.mesh);
    print.uncertainty_mm = std::move(read.uncertainty);
    return print;
  }
  const io::SparseVolume sparse = open_volume(options.print, isovalue);
  model::Volume volume = io::dense_volume(sparse);
  print.bodies = metrology::keep_bodies(volume, *isovalue, {options.pieces_mm3, {}});
  print.mesh = surface_of(options.print, volume, *isovalue);
  if (!options.uncertainty.empty()) {
    const io::SparseVolume known = io::read_volume(options.uncertainty, "uncertainty");
    const auto correlation = [&](const char* name) { return tool::stated_number(known.metadata, name).value_or(0); };
    const metrology::VoxelUncertainty voxels{io::dense_volume(known), correlation("vam:correlation_xy"),
                                             correlation("vam:correlation_z")};
    print.uncertainty_mm = metrology::surface_uncertainty_mm(volume, voxels, print.mesh.points);
  }
  if (options.isovalue_uncertainty > 0) {
    print.mm_per_isovalue = stats::median(metrology::mm_per_value(volume, print.mesh.points));
  }
  tool::unstretch(print.mesh, sparse.metadata);
  return print;
}

}  // namespace vam::sdf_tool

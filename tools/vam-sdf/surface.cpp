// SPDX-License-Identifier: GPL-3.0-or-later

#include "session/surface.hpp"

#include "base/stats/median.hpp"
#include "io/stream/file_type.hpp"
#include "metrology/ost/surface_uncertainty.hpp"
#include "vam-sdf/steps.hpp"

namespace vam::sdf_tool {

PrintSurface read_print(const cli::App& app, const Options& options, std::optional<double> isovalue) {
  PrintSurface print;
  if (!io::is_volume(options.print)) {
    app.require_for("meshes", options.print);
    io::ColouredMesh read = session::read_solid(options.print);
    print.mesh = std::move(read.mesh);
    print.uncertainty_mm = std::move(read.uncertainty);
    return print;
  }
  const auto keep = [&](model::Volume& volume) {
    print.bodies = metrology::keep_bodies(volume, *isovalue, {options.pieces_mm3, {}});
  };
  print.mesh = session::read_surface(options.print, isovalue, keep, [&](const auto& volume, const auto& mesh) {
    if (!options.uncertainty.empty()) {
      const io::SparseVolume known = io::read_volume(options.uncertainty, "uncertainty");
      const auto correlation = [&](const char* name) { return model::stated_number(known.metadata, name).value_or(0); };
      const metrology::VoxelUncertainty voxels{io::dense_volume(known), correlation("vam:correlation_xy"),
                                               correlation("vam:correlation_z")};
      print.uncertainty_mm = metrology::surface_uncertainty_mm(volume, voxels, mesh.points);
    }
    if (options.isovalue_uncertainty > 0)
      print.mm_per_isovalue = stats::median(metrology::mm_per_value(volume, mesh.points));
  });
  return print;
}

}  // namespace vam::sdf_tool

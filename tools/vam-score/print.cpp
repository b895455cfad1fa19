// SPDX-License-Identifier: GPL-3.0-or-later
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "io/mesh/file.hpp"
#include "model/metadata.hpp"
#include "session/surface.hpp"
#include "solid/voxel/isosurface.hpp"
#include "vam-score/outputs.hpp"

namespace vam::score_tool {

void write_print(const Options& options, const io::SparseVolume& dose, double threshold) {
  const auto require_print = [&](bool empty) {
    if (!empty) return;
    throw Error{Fault::data, "nothing prints at a dose of " + format_number(threshold) + " " + dose.units +
                                 "; choose an --isovalue below the largest dose"};
  };
  const std::vector<std::string> comments{"threshold dose " + format_number(threshold) + " " + dose.units};
  if (options.print_as == "mesh") {
    const auto mesh = session::fine_surface(dose, threshold, dose.metadata);
    require_print(mesh.triangles.empty());
    for (const std::string& ending : io::written_mesh_endings())
      if (options.print.ends_with(ending)) return io::write_mesh(options.print, mesh, comments);
    return io::write_ply(options.print, mesh, {}, comments);  // of another name, as of a device
  }
  auto print = solid::printed_points(
      dose.grid(), [&](int k, int count, float* out) { dose.read_slices(k, count, out); }, threshold);
  require_print(print.points.points.empty());
  model::unstretch(print.points, dose.metadata);
  io::write_ply(options.print, print.points, print.values, comments);
}

}  // namespace vam::score_tool

// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "io/mesh/file.hpp"
#include "io/vdb/vdb.hpp"
#include "model/metadata.hpp"
#include "optics/lit_fraction.hpp"
#include "session/surface.hpp"
#include "solid/voxel/isosurface.hpp"
#include "vam-score/outputs.hpp"

namespace vam::score_tool {

namespace {

/// By distance from the axis, in steps of half a voxel, up to the resin's edge.
std::vector<double> fractions_by_radius(const model::Printer& printer, double step_mm) {
  std::vector<double> radii_mm(static_cast<std::size_t>(model::resin_radius_mm(printer.vial) / step_mm) + 1);
  for (std::size_t i = 0; i < radii_mm.size(); ++i) radii_mm[i] = static_cast<double>(i) * step_mm;
  return optics::lit_fractions(printer, radii_mm);
}

}  // namespace

void write_lit_fraction(const std::string& path, const model::Grid& grid, const model::Printer& printer,
                        const cli::App& app) {
  const double step_mm = 0.5 * grid.voxel_mm;
  const std::vector<double> fractions = fractions_by_radius(printer, step_mm);
  std::vector<float> slice(grid.slice_size());
  for (int j = 0; j < grid.ny; ++j) {
    for (int i = 0; i < grid.nx; ++i) {
      const auto at = static_cast<std::size_t>(std::hypot(grid.x_mm(i), grid.y_mm(j)) / step_mm + 0.5);
      if (at < fractions.size()) slice[product(j, grid.nx) + i] = static_cast<float>(fractions[at]);
    }
  }
  io::SparseVolume volume("lit_fraction", grid);
  for (int k = 0; k < grid.nz; ++k) volume.write_slices(k, 1, slice.data());
  volume.units = "fraction of stage angles";
  volume.history.push_back(app.history());
  io::write_volume(path, volume);
}

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

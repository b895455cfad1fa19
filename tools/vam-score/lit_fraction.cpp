// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/lit_fraction.hpp"

#include <cmath>
#include <vector>

#include "base/index.hpp"
#include "io/vdb/vdb.hpp"
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

}  // namespace vam::score_tool

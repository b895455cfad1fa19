// SPDX-License-Identifier: GPL-3.0-or-later
// vam-sdf --volume: how far the print stands outside its design, for the next design.
#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/text/text.hpp"
#include "io/vdb/vdb.hpp"
#include "model/grid_size.hpp"
#include "solid/mesh/repair.hpp"
#include "solid/voxel/compensation.hpp"
#include "vam-sdf/steps.hpp"

namespace vam::sdf_tool {

void write_deviation_volume(const cli::App& app, const Options& options, const model::TriangleSoup& print,
                            const model::TriangleSoup& design, double rms_mm) {
  model::TriangleSoup closed = design;
  const auto repair = solid::repair(closed, options.design);
  if (repair.boundary_edges > 0) {
    throw Error{Fault::data,
                options.design + ": has " + std::to_string(repair.boundary_edges) +
                    " boundary edges, across which inside and outside are not defined; --volume requires a "
                    "closed design"};
  }
  const model::Grid grid = solid::deviation_grid(design, options.volume_voxel_mm);
  require_memory(3.0 * sizeof(float) * static_cast<double>(grid.size()), "--volume: " + model::size_text(grid),
                 "use a larger --volume-voxel");
  const model::Volume deviation = solid::deviation_volume(print, design, grid);
  io::SparseVolume sparse("sdf", grid);
  sparse.write_slices(0, grid.nz, deviation.values.data());
  sparse.units = "mm";
  sparse.history.push_back(app.history());
  sparse.metadata["vam:rms_mm"] = format_number(rms_mm, 9);
  io::write_volume(options.volume, sparse);
}

}  // namespace vam::sdf_tool

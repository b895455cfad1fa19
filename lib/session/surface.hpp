// SPDX-License-Identifier: GPL-3.0-or-later
// The surface of a body: of a mesh, or where a volume has a value.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "io/mesh/file.hpp"
#include "io/vdb/vdb.hpp"
#include "model/mesh.hpp"
#include "model/metadata.hpp"
#include "solid/voxel/placement.hpp"

namespace vam::session {

/// Copies of a mesh, and other meshes beside it.
struct ArrayOptions {
  std::string copies;
  std::vector<std::string> beside;
  double gap = 1;
};
/// --copies, --beside and --gap, not for these kinds and not with these options.
void add_array(cli::App& app, ArrayOptions& options, const std::vector<std::string>& not_for,
               const std::vector<std::string>& excludes);

/// io::read_coloured_mesh() without what a slicer takes away from it. Throws also as solid::difference().
[[nodiscard]] io::ColouredMesh read_solid(const std::string& path, const std::string& others = "");

/// A mesh whose unit may be said on the command line. Throws Fault::usage where `flag` is given for a file that states
/// its unit, by which that of the command line would be multiplied; `scale` is the option to change the size.
[[nodiscard]] model::TriangleSoup mesh_in_unit(const std::string& path, bool given, const std::string& flag,
                                               const std::string& scale);

/// mesh_in_unit(), or the meshes of an array by solid::in_rows(), which are turned as `placement` says, and no more by
/// it. Throws Fault::usage as well for copies that are none, or fewer than the meshes.
[[nodiscard]] model::TriangleSoup array_in_unit(const std::string& path, const ArrayOptions& array, bool given,
                                                solid::Placement& placement);

/// In mm of the part, whose stretch is undone; `prepare` changes a volume before, `measure` takes it with its surface
/// before that is unstretched. Throws Fault::usage for a volume without an isovalue, Fault::data where it does not
/// cross it, otherwise as io::read_volume() and io::check_values(): a target whose surface is beyond 1 is grey.
using MeasureSurface = std::function<void(const model::Volume& volume, const model::TriangleSoup& surface)>;
[[nodiscard]] model::TriangleSoup read_surface(const std::string& path, std::optional<double> isovalue,
                                               const std::function<void(model::Volume&)>& prepare = {},
                                               const MeasureSurface& measure = {});

/// Where a volume reaches the level, by its slices; its stretch, or that of another volume, is undone. Empty where it
/// reaches it nowhere.
[[nodiscard]] model::TriangleSoup fine_surface(const io::SparseVolume& volume, double level,
                                               const model::Metadata& stretched);

}  // namespace vam::session

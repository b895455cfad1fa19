// SPDX-License-Identifier: GPL-3.0-or-later
// What is to be sliced: a mesh, images or a shape, its height in the image, and the insert it is printed around.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "io/vdb/vdb.hpp"
#include "model/mesh.hpp"
#include "model/printer.hpp"
#include "solid/voxel/part.hpp"
#include "vam-slice/options.hpp"

namespace vam::slice_tool {

/// Measurements of previous prints of the design.
struct Correction {
  std::vector<double> rms_mm;  // of each round
  std::size_t applied = 0;     // of them
};

/// Slices of meshes and shapes begin where rows of the projector do.
[[nodiscard]] solid::Part part_of(const Options& options, const model::Projector& projector,
                                  const solid::Writable& room, Correction& correction);

/// The insert of its own size, at the place of the options.
[[nodiscard]] std::optional<solid::Part> insert_of(const Options& options, const solid::Part& part,
                                                   const solid::Writable& room);

/// The lift of the part along z, in whole voxels of the stretched target: to the requested height; to that of least
/// smear by climbing rays; or, unless it keeps its origin, as little as brings it into the image. Throws Fault::usage
/// for an invalid height.
[[nodiscard]] double lift_mm(const Options& options, const model::Printer& printer, const solid::Part& part,
                             const solid::Writable& room);

/// For --report: the lift in the resin.
[[nodiscard]] Json lift_figures(const Options& options, double lift_mm);

/// Is the insert below or above all slices of the volume? Then says so.
[[nodiscard]] bool is_beyond(const solid::Part& placed, const model::Grid& grid, double stretch_z);

/// The part, without the insert with --cut-insert. The volume must outlive what is returned.
[[nodiscard]] solid::Part around(const solid::Part& part, const io::SparseVolume& insert, const Options& options);

/// For --report. Warns of an insert that misses or overlaps the part.
[[nodiscard]] Json insert_figures(const io::SparseVolume& target, const io::SparseVolume& insert,
                                  const solid::Part& placed, const Options& options);

}  // namespace vam::slice_tool

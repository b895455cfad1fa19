// SPDX-License-Identifier: GPL-3.0-or-later
// What is to be sliced: a mesh, images or a shape, and what it is printed around.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "model/mesh.hpp"
#include "solid/voxel/part.hpp"
#include "vam-slice/options.hpp"

namespace vam::slice_tool {

/// Measurements of previous prints of the design.
struct Correction {
  std::vector<double> rms_mm;  // of each round
  std::size_t applied = 0;     // of them
};

/// The mesh displaced by the deviations of the rounds that help.
[[nodiscard]] model::TriangleSoup corrected(model::TriangleSoup mesh, const Options& options, Correction& correction);

/// Slices of meshes and shapes begin where rows of the projector do.
[[nodiscard]] solid::Part part_of(const Options& options, const model::Projector& projector,
                                  const solid::Writable& room, Correction& correction);

/// The insert of its own size, at the place of the options.
[[nodiscard]] std::optional<solid::Part> insert_of(const Options& options, const solid::Part& part,
                                                   const solid::Writable& room);

}  // namespace vam::slice_tool

// SPDX-License-Identifier: GPL-3.0-or-later
// Location of wrong voxels in a finished print: outside the part's box, and slice by slice; pieces of the print.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/dose/stray_cure.hpp"
#include "optimize/target/problem.hpp"
#include "optimize/target/slice_reader.hpp"
#include "verdict/print_pieces.hpp"

namespace vam::optimize {

/// For each slice in use: all its void voxels, if it lies above or below the box; else those beside the box.
struct StraySlices {
  std::vector<model::StrayCure> whole, beside;
};
[[nodiscard]] StraySlices outside_part(std::span<const Slab> dose, const Problem& problem, const model::VoxelBox& box);

/// How many voxels of each slice in use are on the wrong side of the threshold.
[[nodiscard]] std::vector<std::int64_t> wrong_voxels(std::span<const Slab> dose, const Problem& problem);

/// Pieces of slices [first, last) of part and print, slice 0 being number `from` of the source. No voxel prints where
/// none is judged, outside the circle and where inserts are. Not for a grey target.
void count_pieces(std::span<const Slab> dose, const Problem& problem, int first, int last, const VolumeSource& source,
                  int from, verdict::PrintPieceCounter& counter);

}  // namespace vam::optimize

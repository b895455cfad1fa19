// SPDX-License-Identifier: GPL-3.0-or-later
// Location of wrong voxels in a finished print: outside the part's box, and slice by slice; pieces of the print.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/dose/outside.hpp"
#include "optimize/target/problem.hpp"
#include "optimize/target/slice_reader.hpp"
#include "verdict/print_pieces.hpp"

namespace vam::optimize {

/// For each slice in use: all its void voxels, if it lies above or below the box; else those beside the box.
struct OutsideSlices {
  std::vector<model::Outside> whole, beside;
};
[[nodiscard]] OutsideSlices outside_part(std::span<const Slab> dose, const Problem& problem,
                                         const model::VoxelBox& box);

/// How many voxels of each slice in use are on the wrong side of the threshold.
[[nodiscard]] std::vector<std::int64_t> wrong_voxels(std::span<const Slab> dose, const Problem& problem);

/// `count` slices of a slab of doses from lane `first` on, row-major, 0 outside the circle and where inserts are.
[[nodiscard]] std::vector<float> judged_doses(const Slab& dose, std::span<const Label> labels, int first, int count);

/// Pieces of a whole part, and of its print at the threshold. Not for a grey target.
[[nodiscard]] verdict::PrintPieces print_pieces(std::span<const Slab> dose, const Problem& problem,
                                                const VolumeSource& source);

}  // namespace vam::optimize

// SPDX-License-Identifier: GPL-3.0-or-later
// The grid of all resin that the light of a part reaches: the voxels around it that are constrained and judged.
#pragma once

#include "model/dose/stray_cure.hpp"
#include "model/grid.hpp"
#include "model/pose.hpp"
#include "model/printer.hpp"

namespace vam::light {

/// Voxels around a grid.
struct Margin {
  int side = 0;   // on each of the four sides
  int below = 0;  // slices
  int above = 0;
};

/// Up to that radius on the sides.
[[nodiscard]] Margin round_margin(const model::Grid& grid, double radius_mm);
/// Up to that radius (optics::judged_radius_mm) on the sides; below and above as far as the light of the grid's own
/// rows climbs, in any pose. Nothing below and above where rays stay level, but a slice where poses lift the part, as
/// rows then stand between slices. Throws Fault::data as projector_view does.
[[nodiscard]] Margin lit_margin(const model::Printer& printer, const model::Grid& grid, double radius_mm,
                                const model::Poses& poses = {});

/// The grid with so many voxels more on its sides; those that it had stay in place.
[[nodiscard]] model::Grid extended(const model::Grid& grid, const Margin& margin);
/// A box of its voxels, in the grid with the margin.
[[nodiscard]] model::VoxelBox moved(model::VoxelBox box, const Margin& margin);
/// The values of a slice of the grid into one of the grid with the margin, whose other voxels stay as they are.
void place_slice(const float* slice, const model::Grid& grid, const Margin& margin, float* to);

}  // namespace vam::light

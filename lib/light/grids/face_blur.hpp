// SPDX-License-Identifier: GPL-3.0-or-later
// The height over which rays that climb across a horizontal face blur the dose, and where they do so least.
#pragma once

#include <vector>

#include "light/grids/flat_faces.hpp"
#include "model/printer.hpp"

namespace vam::light {

/// By how many voxels a ray climbs from one side of the face to the other: over so much the dose falls from the part's
/// to the void's [physics §11]. 0 where rays stay level.
[[nodiscard]] double blur_voxels(const model::Printer& printer, const FlatFace& face, double voxel_mm);

/// The lift of the part, in whole voxels within the bounds, that makes the mean square of the smear over the area of
/// all faces least; of equal ones that nearest to 0.
[[nodiscard]] double best_lift_mm(const model::Printer& printer, const std::vector<FlatFace>& faces, double voxel_mm,
                                  double least_mm, double most_mm);

}  // namespace vam::light

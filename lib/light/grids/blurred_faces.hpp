// SPDX-License-Identifier: GPL-3.0-or-later
// Horizontal faces that climbing rays blur: which, by how much, and at which height the part would print better.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "light/grids/flat_faces.hpp"
#include "model/printer.hpp"

namespace vam::light {

struct BlurredFace {
  FlatFace face;
  double blur_voxels = 0;         // blur_voxels()
  std::int64_t wrong_voxels = 0;  // on the wrong side of the threshold, in the slices that it is smeared over
};

/// The faces that are smeared by a voxel or more with wrong voxels nearby. wrong: how many each slice of the grid has.
[[nodiscard]] std::vector<BlurredFace> blurred_faces(const model::Printer& printer, const model::Grid& grid,
                                                     std::span<const std::int64_t> wrong,
                                                     const std::vector<FlatFace>& faces);

/// What would make the most smeared of them sharper.
struct FaceRemedy {
  double lift_mm = 0;      // of the part from where it is, in slices' millimetres; 0: it is best where it is
  double blur_voxels = 0;  // of the worst face then
  double tilt_deg = 0;     // about a level axis: then a ray climbs by less than a slice until it has left the face
};
/// With the lift between these bounds.
[[nodiscard]] FaceRemedy face_remedy(const model::Printer& printer, const std::vector<FlatFace>& faces,
                                     const std::vector<BlurredFace>& hard, double voxel_mm, double least_mm,
                                     double most_mm);

/// By how many voxels a ray climbs from one side of the face to the other: over so much the dose falls from the part's
/// to the void's [physics §11]. 0 where rays stay level.
[[nodiscard]] double blur_voxels(const model::Printer& printer, const FlatFace& face, double voxel_mm);

/// The lift of the part, in whole voxels within the bounds, that makes the mean square of the smear over the area of
/// all faces least; of equal ones that nearest to 0.
[[nodiscard]] double best_lift_mm(const model::Printer& printer, const std::vector<FlatFace>& faces, double voxel_mm,
                                  double least_mm, double most_mm);

}  // namespace vam::light

// SPDX-License-Identifier: GPL-3.0-or-later
// A dose in a file scored against the target in another, slab by slab: both on the same grid.
#pragma once

#include <string>

#include "io/vdb/vdb.hpp"
#include "model/metadata.hpp"
#include "model/printer.hpp"
#include "score/grey_score.hpp"
#include "score/score.hpp"
#include "session/grey_target.hpp"
#include "verdict/sub_voxel_features.hpp"

namespace vam::session {

/// Features of a target that are too fine for its voxels, with what it states of its own surface.
[[nodiscard]] verdict::SubVoxelFeatures unresolved(const io::SparseVolume& target);

/// How far from the axis void is judged: optics::judged_radius_mm, but not farther than `light` states (of the
/// projections, or their dose) that vam-optimize did [formats: Attributes of volumes and prints].
[[nodiscard]] double judged_radius_mm(const io::SparseVolume& target, const model::Printer& printer,
                                      const model::Metadata& light);

/// Fills in the circle that is judged, void outside which is not, the threshold that the light was made for, and for a
/// dose in mJ/cm3 of a resin with a critical dose the exposure, with that threshold where it is the dose of a whole
/// print.
void resolve_exposure(score::ScoreOptions& how, const io::SparseVolume& dose, const io::SparseVolume& target,
                      const model::Printer& printer);

/// Against coverage.
[[nodiscard]] score::Score score_volumes(const io::SparseVolume& dose, const io::SparseVolume& target,
                                         const score::ScoreOptions& how);
/// Against coverage, and by the pieces of the print.
[[nodiscard]] score::Score score_print(const io::SparseVolume& dose, const io::SparseVolume& target,
                                       score::ScoreOptions how);

/// Against a grey target. band: of each voxel, where `grey` names no file of them, that of `grey` around it; null: it
/// is the same for all. Throws as require_linear() and grey_unit() do, whose messages `file` begins, and Fault::data
/// where the band is on another grid.
[[nodiscard]] score::GreyScore score_grey(const io::SparseVolume& dose, const io::SparseVolume& target,
                                          const GreyChoice& grey, const io::SparseVolume* band,
                                          const model::Printer& printer, const std::string& file);

}  // namespace vam::session

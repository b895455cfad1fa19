// SPDX-License-Identifier: GPL-3.0-or-later
// A print corrects its design: what stood out is taken off the next one, and the other way round.
#pragma once

#include <span>

#include "model/grid.hpp"
#include "model/mesh.hpp"

namespace vam::solid {

/// The grid of deviations from a design: its box and a margin of a twelfth of its largest side or of six voxels.
/// voxel_mm 0: a hundredth of that side.
[[nodiscard]] model::Grid deviation_grid(const model::TriangleSoup& design, double voxel_mm);

/// How far a print, where it was aligned, stands outside its design, around the surface of the design, in mm: the
/// signed distance of the design less that of the print, both cut off at the margin of the grid [physics §13.4]. Both
/// are closed surfaces.
[[nodiscard]] model::Volume deviation_volume(const model::TriangleSoup& print, const model::TriangleSoup& design,
                                             const model::Grid& grid);

/// How many of the rounds, in their order, make the best correction: all of them while each is better than those
/// before by more than `uncertainty_mm`; else it has settled, at the best up to there, which was printed with the
/// rounds before it.
[[nodiscard]] std::size_t rounds_to_apply(std::span<const double> rms_mm, double uncertainty_mm);

/// The design displaced by -damping times the sum of the deviations of these rounds, as a closed surface at their
/// voxels. All have one grid, which is that of this design. Throws Fault::data when they have not, and when nothing of
/// the design remains.
[[nodiscard]] model::TriangleSoup compensated(const model::TriangleSoup& design, std::span<const model::Volume> rounds,
                                              double damping);

}  // namespace vam::solid

// SPDX-License-Identifier: GPL-3.0-or-later
// Plausibility warnings on the size of a sliced part.
#pragma once

#include <string>
#include <vector>

#include "solid/voxel/part.hpp"

namespace vam::solid {

/// The units that a mesh may be in.
[[nodiscard]] const std::vector<std::string>& unit_names();
[[nodiscard]] double mm_per(const std::string& unit);

/// "FILE: the part is only 0.02 mm large; is its unit m?" of a body (part, insert) that is less than a tenth as large
/// as the writable width when read in mm: the units in which it would be between a quarter and twelve times as large.
/// Else empty.
[[nodiscard]] std::string unit_doubt(const std::string& subject, const std::string& body, double largest_mm,
                                     const Writable& room);

/// "is its unit um?" of a body too large when read in mm: the units in which it would be between a twentieth of the
/// writable width and one and a half. Else empty.
[[nodiscard]] std::string finer_unit(double largest_mm, const Writable& room);

/// Voxels that would be wholly inside a flat part of which none is: half as large as the part is thick, if it lies
/// level.
[[nodiscard]] double resolving_voxel_mm(const FillSummary& content, const model::Grid& grid);

/// Voxels, in two digits, that show whether all thin places of the part's own surface print; where it has or states
/// none, half as large.
[[nodiscard]] double telling_voxel_mm(const verdict::SubVoxelFeatures& unresolved, double voxel_mm);

/// Empty, or what a warning should say: no voxel is wholly inside the part (metres, coarse voxels, a thin sheet), or it
/// is less than a tenth as large as the writable width. `unit_known`: the user has stated what a unit of the file is,
/// or how large the part.
[[nodiscard]] std::string size_doubt(const Part& part, const FillSummary& content, const model::Grid& grid,
                                     double stretch_z, const Writable& room, bool unit_known);

/// What warnings should say of walls that will not be printed, from a thousandth of the part on, of rods, from half a
/// voxel of coverage without a half covered voxel within three on, and of gaps that will be printed shut, from the
/// volume of a voxel, a tenth of one a slice and a width of 0.05 voxels on; else of thin places, or where the part's
/// surface is not known of much that is not judged.
[[nodiscard]] std::vector<std::string> resolution_doubts(const std::string& subject,
                                                         const verdict::SubVoxelFeatures& unresolved,
                                                         const model::Grid& grid, double stretch_z);

}  // namespace vam::solid

// SPDX-License-Identifier: GPL-3.0-or-later
// Flat sections of a volume, as images.
#pragma once

#include <array>
#include <vector>

#include "base/image.hpp"
#include "io/vdb/vdb.hpp"
#include "plot/contour.hpp"

namespace vam::plot {

enum class Plane {
  axial,     // across the rotation axis: x to the right, y up
  coronal,   // along it: x to the right, z up, seen against y
  sagittal,  // along it: y to the right, z up
};

/// Number of sections and the place of one in mm along the third axis; and the other way, clamped to the volume.
[[nodiscard]] int plane_count(const model::Grid& grid, Plane plane);
[[nodiscard]] double plane_mm(const model::Grid& grid, Plane plane, double index);
[[nodiscard]] int plane_index(const model::Grid& grid, Plane plane, double mm);

/// Names of the axes to the right, up and across: {"x", "y", "z"} for axial.
struct PlaneAxes {
  const char* right;
  const char* up;
  const char* across;
};
[[nodiscard]] PlaneAxes plane_axes(Plane plane);

/// The mm at the middle of the first column and of the lowest row.
[[nodiscard]] Spot plane_origin_mm(const model::Grid& grid, Plane plane);

/// A section without values.
[[nodiscard]] Image plane_shape(const model::Grid& grid, Plane plane);

/// The i and j of the voxel at pixel (x, y) of the section at that index.
[[nodiscard]] std::array<int, 2> plane_column(const model::Grid& grid, Plane plane, int index, int x, int y);

/// Sections at these indices, in their order, row 0 at the top. Reads the volume once, slab by slab.
[[nodiscard]] std::vector<Image> planes(const io::SparseVolume& volume, Plane plane, const std::vector<int>& indices);

/// The outline (coverage 1/2) of a target at places in mm, in the pixels of the sections of another grid. Places that
/// the target does not reach have none.
[[nodiscard]] std::vector<std::vector<ContourPiece>> outlines(const io::SparseVolume& target, const model::Grid& grid,
                                                              Plane plane, const std::vector<double>& places_mm);

}  // namespace vam::plot

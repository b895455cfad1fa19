// SPDX-License-Identifier: GPL-3.0-or-later
// Known errors of a print's surface.
#pragma once

#include <string>
#include <vector>

#include "model/mesh.hpp"
#include "solid/mesh/signed_distance.hpp"

namespace vam::metrology {

/// Standard uncertainties along the normal.
struct SurfaceErrors {
  std::string source;            // "volume", "mesh" or "roughness"
  std::vector<float> vertex_mm;  // of each vertex of the print, independent from cell to cell
  double cell_mm = 0;
  double common_mm = 0;      // of the whole surface at once: that of the isovalue
  double scale = 0;          // relative: that of the camera's pixel pitch
  double resolution_mm = 0;  // of the whole surface at once: what voxels, columns and angles leave
  double extreme_mm = 0;     // of the places that err most, by which an extreme differs
};

/// Standard uncertainty of a volume's surface, in its cells, measured on cylinders [physics §8].
inline constexpr double resolved_cells = 0.04;

/// And of the extremes, where a face and its rim ripple: of noise-free views flatness and cylindricity are up to 0.8
/// cells too large.
inline constexpr double extreme_cells = 0.4;

/// From the mesh alone: how the distances of neighbouring vertices differ, by the median magnitude, over
/// sqrt(2), for edges shorter than 2 % of the design. What neighbours have in common is not seen.
[[nodiscard]] SurfaceErrors roughness(const model::TriangleSoup& print, const solid::Surface& design,
                                      double largest_dimension_mm);
/// Mean edge of a mesh: the cells of its errors.
[[nodiscard]] double mean_edge_mm(const model::TriangleSoup& mesh);

}  // namespace vam::metrology

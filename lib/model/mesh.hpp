// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh as it comes out of a file: points and triangles, with no promise that they are welded, closed or oriented.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace vam::model {

/// Triangle soup in mm, right-handed, z up. A triangle is three indices into points, anticlockwise seen from outside
/// where the file gives one. Readers guarantee: finite points, indices in range, at least one triangle.
struct TriangleSoup {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 3>> triangles;
};

/// What may be stored at every vertex beside its position. Each array is empty or has one entry per point.
struct VertexData {
  std::vector<float> quality;                        // signed distance in mm, or any scalar worth colouring
  std::vector<std::array<std::uint8_t, 3>> colours;  // red, green, blue
  std::vector<float> uncertainty = {};               // standard, of the position along the normal, in mm
};

}  // namespace vam::model

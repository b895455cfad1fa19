// SPDX-License-Identifier: GPL-3.0-or-later
// What a profilometer would see of a mesh: its heights from above.
#pragma once

#include "base/image.hpp"
#include "model/mesh.hpp"

namespace vam::solid {

/// Heights in mm, row 0 at the largest y; not a number where there is no material.
struct HeightMap {
  Image heights_mm;
  double pixel_mm = 0;
  double x_mm = 0;  // of the middle of pixel (0, 0)
  double y_mm = 0;
};

/// The highest z of the mesh over every pixel's middle, with an empty rim of one pixel. Throws Fault::data when the
/// map would have more than 1e8 pixels.
[[nodiscard]] HeightMap height_map(const model::TriangleSoup& mesh, double pixel_mm);

}  // namespace vam::solid

// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies as they look from above at an angle, in parallel light.
#pragma once

#include <vector>

#include "base/pixels.hpp"
#include "base/vector3.hpp"
#include "model/mesh.hpp"

namespace vam::plot {

struct Body {
  model::TriangleSoup mesh;
  std::vector<Rgb> colours;  // one a point; none: grey
};

/// Where the eye is, far away: turned from -y about z, and above the plane.
struct Eye {
  double azimuth_deg = 30;
  double elevation_deg = 25;
};

/// The side of the smallest square around `centre` that holds them.
[[nodiscard]] double side_mm(const std::vector<const Body*>& bodies, const Vector3& centre, Eye eye);

/// A square of `side_mm` around `centre`, `pixels` wide, z upwards, without perspective, so that a millimetre across
/// the line of sight is as long everywhere; white where there is nothing.
[[nodiscard]] RgbImage render(const std::vector<const Body*>& bodies, const Vector3& centre, double side_mm, Eye eye,
                              int pixels);

}  // namespace vam::plot

// SPDX-License-Identifier: GPL-3.0-or-later
// Where the camera's volumes stand in the projector's frame, from a print whose design is known.
#pragma once

#include <string>

#include "base/stats/measured.hpp"
#include "model/mesh.hpp"
#include "solid/mesh/signed_distance.hpp"

namespace vam::metrology {

/// What takes the print onto the design.
struct Registration {
  stats::Measured angle_deg;  // about the rotation axis, counter-clockwise seen from above
  stats::Measured z_mm;       // of the middle of its surface
  double middle_z_mm = 0;     // where that is in the print
  stats::Measured scale;
  double aside_mm = 0;    // across the axis, and
  double tilt_deg = 0;    // of the axis: what no setting of the camera explains
  double outside_mm = 0;  // by which the print is larger all around: its exposure, or the isovalue
  double rms_mm = 0;      // of the print's surface from the design thereafter
  std::string failure;    // why it must not be used; empty: it may
};

/// Least squares along the normals from where the print is, which must be near (a few degrees, a fifth of its size)
/// [physics §13.3]. Standard deviations are from 16 parts of the surface, whose errors are taken to be independent;
/// that of the scale has a fifth of the camera's pixel over the mean distance from the middle, too.
[[nodiscard]] Registration registration(const model::TriangleSoup& print, const solid::Surface& design,
                                        double pixel_mm);

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
// Where the vial stands in the projector's field: a lit column sweeps across it, and a camera at its side sees
// fluorescence only while the line crosses resin [RAY21 "Printing procedure", RAY21 eq 9; physics §10].
#pragma once

#include <vector>

#include "base/stats/measured.hpp"
#include "model/printer.hpp"

namespace vam::metrology {

/// What the camera saw of the sweep, by height.
struct SweepScan {
  double width_px = 1;                      // of the line
  std::vector<double> column;               // middle of the line in each frame, projector columns, rising
  std::vector<double> height_mm;            // of each band's middle, upwards
  std::vector<std::vector<double>> signal;  // [band][frame], mean camera value
};

struct VialEdges {
  stats::Measured axis_column;  // where the vial's middle appears at height 0, projector columns
  stats::Measured edge_px;      // R_e: half the distance of the two edge columns
  stats::Measured radius_mm;    // outer radius of the vial
  stats::Measured tilt_deg;  // of the vial against the projector's columns, its upper end towards higher columns; n = 0
                             // with fewer than two bands
  stats::Measured blur_px;   // Gaussian sigma of the line at the edge
  std::vector<stats::Measured> centre_column;  // of each band; n = 0: no edges seen
};

/// Fits both edges of every band with what the optics lets a camera at its place see of a sheet of light near grazing
/// incidence (SightLines), blurred by the line's width and a Gaussian, times a share at either edge. `printer` gives
/// projector, wall, indices, absorption and the camera's distance and azimuth; its vial radius and axis_column are not
/// used. Throws Fault::data: a camera not 60 to 91 degrees from the projector, no band shows two edges, or the line's
/// columns do not reach beyond both.
[[nodiscard]] VialEdges find_edges(const SweepScan& scan, const model::Printer& printer);

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
// Dose of a stereolithographic print by marching through time with Beer's law in physical units: no recursion, no
// dimensionless numbers, no closed form. Slow and obvious; shares nothing with lib/resin.
#pragma once

#include <vector>

namespace vam::oracle {

struct Print {
  double slice_mm;
  double absorbance_height_mm;  // intensity falls to a tenth in this depth
  double speed_mm_s;
  std::vector<double> intensity_mw_cm2;  // at the window, one per slice
  int steps_per_slice = 2000;            // of time
};

/// mJ/cm3 at height z_mm below the platform after a continuous print: the window moves away from the platform at
/// constant speed and the slice changes when it has moved by one slice height.
double continuous_dose_mj_cm3(const Print& print, double z_mm);

/// The same for layer by layer: the window rests at the far end of each layer for the time of a slice. The point counts
/// as part of the layer that begins at z_mm.
double layered_dose_mj_cm3(const Print& print, double z_mm);

}  // namespace vam::oracle

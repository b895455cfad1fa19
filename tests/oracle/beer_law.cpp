// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/beer_law.hpp"

#include <cmath>
#include <cstddef>

namespace vam::oracle {

namespace {

// mW/cm3 absorbed at distance depth_mm from the window: -dI/dz with I = I0 10^(-depth/h_a).
double absorbed(const Print& print, std::size_t slice, double depth_mm) {
  const double per_cm = std::log(10.0) / (print.absorbance_height_mm * 0.1);
  return print.intensity_mw_cm2[slice] * per_cm * std::pow(10.0, -depth_mm / print.absorbance_height_mm);
}

}  // namespace

double continuous_dose_mj_cm3(const Print& print, double z_mm) {
  const double slice_s = print.slice_mm / print.speed_mm_s;
  const double step_s = slice_s / print.steps_per_slice;
  double dose = 0;
  for (std::size_t n = 0; n < print.intensity_mw_cm2.size(); ++n) {
    for (int step = 0; step < print.steps_per_slice; ++step) {
      const double time_s = static_cast<double>(n) * slice_s + (step + 0.5) * step_s;  // midpoint rule
      const double window_mm = print.speed_mm_s * time_s;
      if (window_mm < z_mm) continue;  // this resin is not there yet
      dose += absorbed(print, n, window_mm - z_mm) * step_s;
    }
  }
  return dose;
}

double layered_dose_mj_cm3(const Print& print, double z_mm) {
  const double slice_s = print.slice_mm / print.speed_mm_s;
  double dose = 0;
  for (std::size_t n = 0; n < print.intensity_mw_cm2.size(); ++n) {
    const double window_mm = static_cast<double>(n + 1) * print.slice_mm;
    if (window_mm < z_mm + 0.5 * print.slice_mm) continue;  // the layer that begins at z is not there yet
    for (int step = 0; step < print.steps_per_slice; ++step) {
      dose += absorbed(print, n, window_mm - z_mm) * slice_s / print.steps_per_slice;
    }
  }
  return dose;
}

}  // namespace vam::oracle

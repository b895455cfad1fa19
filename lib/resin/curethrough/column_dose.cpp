// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/column_dose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.hpp"
#include "base/text/text.hpp"

namespace vam::resin {

namespace {

void check_positive(const char* what, double value, const char* unit) {
  if (std::isfinite(value) && value > 0) return;
  throw Error{Fault::data, std::string(what) + ": " + format_number(value) + " " + unit + " is not a positive number"};
}

void check(const Process& p) {
  check_positive("slice height", p.slice_um, "um");
  check_positive("absorbance height", p.absorbance_height_um, "um");
  check_positive("full-cure dose", p.full_cure_dose_mj_cm3, "mJ/cm3");
  check_positive("print speed", p.speed_mm_h, "mm/h");
  check_positive("maximum intensity", p.max_intensity_mw_cm2, "mW/cm2");
  if (!(p.min_intensity_mw_cm2 >= 0 && p.min_intensity_mw_cm2 < p.max_intensity_mw_cm2)) {
    throw Error{Fault::data, "intensity range: the minimum, " + format_number(p.min_intensity_mw_cm2) +
                                 " mW/cm2, must be at least 0 and below the maximum, " +
                                 format_number(p.max_intensity_mw_cm2) + " mW/cm2"};
  }
  if (p.slice_um > 10 * p.absorbance_height_um) {
    throw Error{Fault::data, "slice height: " + format_number(p.slice_um) +
                                 " um is more than ten absorbance heights (" + format_number(p.absorbance_height_um) +
                                 " um), no light crosses a slice; reduce the slice height or check the units"};
  }
}

}  // namespace

double full_cure_intensity_mw_cm2(const Process& process) {
  const double speed_cm_s = process.speed_mm_h / 36000.0;
  const double continuous = speed_cm_s * process.full_cure_dose_mj_cm3;  // I_f = s D_f
  if (process.exposure == ExposureMode::continuous) return continuous;
  return continuous * process.absorbance_height_um / (std::numbers::ln10 * process.slice_um);
}

CureLimits limits_of(const Process& process) {
  check(process);
  const double q = std::pow(10.0, -process.slice_um / process.absorbance_height_um);
  const double critical = full_cure_intensity_mw_cm2(process);
  return {process.exposure, q, process.exposure == ExposureMode::continuous ? 1 - q : q,
          process.min_intensity_mw_cm2 / critical, process.max_intensity_mw_cm2 / critical};
}

std::vector<double> dose_at_nodes(std::span<const double> phi, const CureLimits& limits) {
  std::vector<double> omega(phi.size() + 1, 0.0);
  for (std::size_t n = phi.size(); n-- > 0;) omega[n] = limits.next(phi[n], omega[n + 1]);
  return omega;
}

double dose_at_centre(double phi, double next_node, const CureLimits& limits) {
  const double half = std::sqrt(limits.q);
  if (limits.exposure == ExposureMode::layered) return half * (phi + next_node);
  return phi * (1 - half) + half * next_node;
}

double cured_fraction(double phi, double next_node, double threshold, const CureLimits& limits) {
  // u in [0, 1] = distance from the window side of the slice, in slices; the dose there is far + (near - far) q^u.
  const bool layered = limits.exposure == ExposureMode::layered;
  const double near = layered ? phi + next_node : next_node;  // a layer's own light arrives without loss
  const double settled = layered ? 0.0 : phi;
  const double back = settled + (near - settled) * limits.q;
  if (near >= threshold && back >= threshold) return 1;
  if (near < threshold && back < threshold) return 0;
  const double crossing = std::log((threshold - settled) / (near - settled)) / std::log(limits.q);
  return std::clamp(near >= threshold ? crossing : 1 - crossing, 0.0, 1.0);
}

int burst_slices(const CureLimits& limits) {
  const double settled = limits.settled(limits.phi_max);
  if (!(settled > 1)) return 0;
  const double count = std::log(1 - 1 / settled) / std::log(limits.q);  // settled (1 - q^count) = 1
  const double whole = std::ceil(count - 1e-9);
  return whole < 1e6 ? std::max(1, static_cast<int>(whole)) : 0;
}

int extra_slices(int last_slice, int slices, const CureLimits& limits) {
  if (last_slice < 0) return 0;
  const int last_node = last_slice + (limits.exposure == ExposureMode::continuous ? 1 : 0);
  return std::max(0, last_node + burst_slices(limits) - slices);
}

}  // namespace vam::resin

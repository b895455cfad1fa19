// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/working_curve.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/distributions.hpp"
#include "base/stats/line.hpp"
#include "base/text/text.hpp"

namespace vam::resin {

namespace {

constexpr double ln10 = std::numbers::ln10;

/// The thickness by the logarithm of the exposure.
struct FittedLine : stats::Line {
  double variance = 0;  // of the residuals
};

using Groups = std::map<double, std::vector<double>>;  // thickness by exposure

Groups checked(std::span<const CuredSample> samples) {
  Groups groups;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& [exposure, thickness] = samples[i];
    if (!(std::isfinite(exposure) && exposure > 0 && std::isfinite(thickness) && thickness > 0)) {
      throw Error{Fault::data, "working curve: sample " + std::to_string(i + 1) + " has exposure " +
                                   format_number(exposure) + " mJ/cm2 and thickness " + format_number(thickness) +
                                   " um; give positive numbers and leave out what did not gel"};
    }
    groups[exposure].push_back(thickness);
  }
  if (groups.size() < 3) {
    throw Error{Fault::data, "working curve: " + std::to_string(groups.size()) +
                                 " different exposures are too few for a line fit; measure at least 3"};
  }
  return groups;
}

FittedLine fit(std::span<const CuredSample> samples) {
  std::vector<double> powers, thicknesses;
  for (const CuredSample& sample : samples) {
    powers.push_back(std::log10(sample.exposure_mj_cm2));
    thicknesses.push_back(sample.thickness_um);
  }
  return {stats::straight_line(powers, thicknesses)};
}

// Where the line crosses 0, in x - mean_x, with Fieller's interval: all u with
// (mean_y + slope u)^2 <= t^2 s^2 (1/n + u^2 / spread).
Interval fieller(const FittedLine& line, double count, double t) {
  const double noise = t * t * line.variance;
  const double a = line.slope * line.slope - noise / line.spread;
  const double b = line.mean_y * line.slope;
  const double c = line.mean_y * line.mean_y - noise / count;
  if (a <= 0) {
    throw Error{Fault::data, "working curve: the thickness does not rise with the exposure beyond its scatter (" +
                                 format_number(line.slope, 3) + " um per decade, " +
                                 format_number(std::sqrt(line.variance), 3) + " um about the line); check the columns"};
  }
  const double root = std::sqrt(std::fmax(0.0, b * b - a * c));
  return {(-b - root) / a, (-b + root) / a};
}

// The repeats' own scatter, and whether their means leave the line by more (F test).
void judge_repeats(const Groups& groups, double residual_squares, WorkingCurve& curve) {
  double squares = 0;
  for (const auto& [exposure, values] : groups) {
    double mean = 0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    for (const double value : values) squares += (value - mean) * (value - mean);
  }
  const double pure = curve.samples - curve.exposures;
  const double lack = curve.exposures - 2;
  if (pure <= 0) return;
  curve.repeat_sd_um = std::sqrt(squares / pure);
  const double excess = std::fmax(0.0, residual_squares - squares);
  if (squares > 0) curve.lack_of_fit_p = stats::f_tail(excess / lack / (squares / pure), lack, pure);
}

void flag_outliers(std::span<const CuredSample> samples, const FittedLine& line, double residual_squares,
                   WorkingCurve& curve) {
  const auto count = static_cast<double>(samples.size());
  curve.outlier.assign(samples.size(), false);
  if (samples.size() < 4 || residual_squares <= 0) return;
  const double bound = stats::student_quantile(0.05 / count, count - 3);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double dx = std::log10(samples[i].exposure_mj_cm2) - line.mean_x;
    const double free = 1 - 1 / count - dx * dx / line.spread;  // 1 - leverage
    if (free <= 1e-12) continue;                                // the line goes through this sample by itself
    const double own = curve.residual_um[i] * curve.residual_um[i] / free;
    const double rest = std::fmax(0.0, residual_squares - own) / (count - 3);
    curve.outlier[i] = own > bound * bound * rest;
  }
}

/// h_a, E_c and D_c of the line, with their bounds at `t` of Student's [physics §14.4].
void set_values(const FittedLine& line, double count, double t, WorkingCurve& curve) {
  const Interval crossing = fieller(line, count, t);
  const double slope_error = std::sqrt(line.variance / line.spread);
  const double offset = -line.mean_y / line.slope;  // log10 E_c - mean_x
  curve.absorbance_height_um = line.slope;
  curve.absorbance_height_range_um = {line.slope - t * slope_error, line.slope + t * slope_error};
  curve.penetration_depth_um = line.slope / ln10;
  curve.critical_exposure_mj_cm2 = std::pow(10, line.mean_x + offset);
  curve.critical_exposure_range_mj_cm2 = {std::pow(10, line.mean_x + crossing.low),
                                          std::pow(10, line.mean_x + crossing.high)};
  curve.gel_dose_mj_cm3 = ln10 * curve.critical_exposure_mj_cm2 / (line.slope * 1e-4);  // um to cm
  // ln D_c = const + ln(10) (-mean_y / slope) - ln(slope); mean_y and slope are independent.
  const double by_mean = -ln10 / line.slope;
  const double by_slope = -ln10 * offset / line.slope - 1 / line.slope;
  const double log_error = std::sqrt(line.variance * (by_mean * by_mean / count + by_slope * by_slope / line.spread));
  curve.gel_dose_range_mj_cm3 = {curve.gel_dose_mj_cm3 * std::exp(-t * log_error),
                                 curve.gel_dose_mj_cm3 * std::exp(t * log_error)};
}

}  // namespace

WorkingCurve fit_working_curve(std::span<const CuredSample> samples, double confidence) {
  const Groups groups = checked(samples);
  FittedLine line = fit(samples);
  WorkingCurve curve;
  curve.confidence = confidence;
  curve.samples = count_of(samples);
  curve.exposures = count_of(groups);
  const auto count = static_cast<double>(samples.size());

  double residual_squares = 0;
  double total_squares = 0;
  for (const CuredSample& sample : samples) {
    const double residual = sample.thickness_um - line.at(std::log10(sample.exposure_mj_cm2));
    curve.residual_um.push_back(residual);
    residual_squares += residual * residual;
    total_squares += (sample.thickness_um - line.mean_y) * (sample.thickness_um - line.mean_y);
  }
  line.variance = residual_squares / (count - 2);
  const double t = stats::student_quantile(1 - confidence, count - 2);
  if (!(line.slope > 0)) {
    throw Error{Fault::data, "working curve: the thickness falls as the exposure rises (" +
                                 format_number(line.slope, 3) + " um per decade); check the order of the columns"};
  }
  set_values(line, count, t, curve);
  curve.residual_sd_um = std::sqrt(line.variance);
  curve.r_squared = total_squares > 0 ? 1 - residual_squares / total_squares : 1;
  judge_repeats(groups, residual_squares, curve);
  flag_outliers(samples, line, residual_squares, curve);
  return curve;
}

}  // namespace vam::resin

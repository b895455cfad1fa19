// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/response.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/error.hpp"
#include "base/stats/isotonic.hpp"
#include "base/text/text.hpp"

namespace vam::metrology {

namespace {

constexpr std::size_t fewest_levels = 17;
constexpr std::size_t fewest_readings = 3;

void require_ramp(const ResponseScan& scan) {
  if (scan.grey.size() < fewest_levels) {
    throw Error{Fault::data, "response: " + std::to_string(scan.grey.size()) + " grey levels; at least " +
                                 std::to_string(fewest_levels) + " are needed"};
  }
  for (std::size_t i = 0; i < scan.grey.size(); ++i) {
    if (i == 0 ? scan.grey[0] != 0 : scan.grey[i] <= scan.grey[i - 1]) {
      throw Error{Fault::data, "response: the grey levels must rise from 0; level " + std::to_string(i) + " is " +
                                   format_number(scan.grey[i])};
    }
    if (scan.light[i].size() < fewest_readings) {
      throw Error{Fault::data, "response: " + std::to_string(scan.light[i].size()) + " readings of grey " +
                                   format_number(scan.grey[i]) + "; at least " + std::to_string(fewest_readings) +
                                   " are needed to estimate the variance"};
    }
  }
}

/// The nearest curve that never falls.
std::vector<stats::Measured> monotone(const std::vector<stats::Measured>& levels) {
  std::vector<double> values;
  for (const stats::Measured& level : levels) values.push_back(level.value);
  std::vector<stats::Measured> out;
  for (const stats::Pool& pool : stats::isotonic(values, std::vector<double>(values.size(), 1.0))) {
    const std::span<const stats::Measured> pooled(levels.data() + out.size(), pool.size);
    double variance = 0;
    for (const stats::Measured& level : pooled) variance += level.sigma * level.sigma;
    // Pooling assumes that the true levels are equal; what a single level could still be is not known any better.
    const double sigma = std::sqrt(variance / static_cast<double>(pool.size));
    for (const stats::Measured& level : pooled) out.push_back({pool.mean(), sigma, level.n});
  }
  return out;
}

// A camera that clips, at whichever value, reads the same for the brightest levels.
void require_rising_end(const std::vector<double>& grey, const std::vector<stats::Measured>& levels) {
  constexpr double same = 1e-3;      // of full: far below the noise of a camera, which clipping takes away
  constexpr double shortest = 0.06;  // of the grey range: one of 16 steps; a response of gamma 0.45 rises by 3 % there
  const double full = levels.back().value;
  std::size_t first = levels.size() - 1;
  while (first > 0 && std::abs(levels[first - 1].value - full) <= same * full) --first;
  if (grey.back() - grey[first] < shortest * grey.back()) return;
  throw Error{Fault::data, "response: grey " + format_number(grey[first]) + " to " + format_number(grey.back()) +
                               " have the same reading, " + format_number(full) +
                               "; the camera saturates, shorten the exposure"};
}

}  // namespace

ResponseCurve measure_response(const ResponseScan& scan) {
  require_ramp(scan);
  std::vector<stats::Measured> means;
  for (const auto& readings : scan.light) means.push_back(stats::mean_of(readings));
  const std::vector<stats::Measured> risen = monotone(means);
  const stats::Measured full = risen.back();
  const stats::Measured black = risen.front();
  constexpr double least_rise = 0.05;  // of full: a dim room leaves a projector more contrast
  const double rise = full.value - black.value;
  if (!(full.value > 3 * full.sigma) || !(rise > 5 * std::hypot(full.sigma, black.sigma)) ||
      rise < least_rise * full.value) {
    throw Error{Fault::data,
                "response: full grey reads " + format_number(full.value) + " and black " + format_number(black.value) +
                    "; no light of the projector reaches the camera: check the lamp and its aperture, keep "
                    "other light out, and give --dark"};
  }
  require_rising_end(scan.grey, means);
  ResponseCurve curve;
  curve.grey = scan.grey;
  for (std::size_t i = 0; i < risen.size(); ++i) {
    if (std::abs(means[i].value - risen[i].value) > std::max(5 * means[i].sigma, 0.005 * full.value)) {
      throw Error{Fault::data, "response: the intensity falls by " +
                                   format_number(100 * std::abs(means[i].value - risen[i].value) / full.value, 3) +
                                   " % of full around grey " + format_number(scan.grey[i]) +
                                   "; let the lamp warm up, or shorten the exposure of a saturated camera"};
    }
    const bool last = risen[i].value >= full.value;
    const double part = std::max(risen[i].value, 0.0) / full.value;
    curve.intensity.push_back(
        {part, last ? 0 : std::hypot(risen[i].sigma, part * full.sigma) / full.value, risen[i].n});
  }
  return curve;
}

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/response_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "base/error.hpp"
#include "base/stats/isotonic.hpp"
#include "base/text/text.hpp"

namespace vam::resin {

namespace {

struct GreyLevel {
  double grey = 0;
  double mean = 0;
  double count = 0;
};

std::vector<GreyLevel> averaged(std::span<const PhotodiodeReading> readings, double dark, double& noise) {
  std::map<double, std::vector<double>> groups;
  for (const PhotodiodeReading& r : readings) groups[r.grey].push_back(r.reading - dark);
  std::vector<GreyLevel> levels;
  double squares = 0;
  double freedom = 0;
  for (const auto& [grey, values] : groups) {
    double mean = 0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    for (const double value : values) squares += (value - mean) * (value - mean);
    freedom += static_cast<double>(values.size() - 1);
    levels.push_back({grey, mean, static_cast<double>(values.size())});
  }
  noise = freedom > 0 ? std::sqrt(squares / freedom) : 0;
  return levels;
}

void check(const std::vector<GreyLevel>& levels, double noise, const std::string& source) {
  if (levels.size() < 3) {
    throw Error{Fault::data,
                source + ": " + std::to_string(levels.size()) + " grey levels do not make a curve; measure at least 3"};
  }
  if (levels.front().grey != 0) {
    throw Error{Fault::data, source + ": the lowest grey is " + format_number(levels.front().grey) +
                                 "; measure grey 0 too, it sets the contrast"};
  }
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const double fall = levels[i - 1].mean - levels[i].mean;
    const double error = noise * std::sqrt(1 / levels[i - 1].count + 1 / levels[i].count);
    if (fall > 3 * error) {
      throw Error{Fault::data, source + ": the reading falls from " + format_number(levels[i - 1].mean) + " at grey " +
                                   format_number(levels[i - 1].grey) + " to " + format_number(levels[i].mean) +
                                   " at grey " + format_number(levels[i].grey) +
                                   ", beyond the noise; a response must rise, measure again"};
    }
  }
  if (!(levels.back().mean > 0))
    throw Error{Fault::data, source + ": zero intensity at full grey; check the dark reading"};
}

/// Makes the means such as never fall; how many were pooled.
int pool(std::vector<GreyLevel>& levels) {
  std::vector<double> means;
  std::vector<double> counts;
  for (const GreyLevel& level : levels) {
    means.push_back(level.mean);
    counts.push_back(level.count);
  }
  std::size_t i = 0;
  int pooled = 0;
  for (const stats::Pool& equal : stats::isotonic(means, counts)) {
    if (equal.size > 1) pooled += static_cast<int>(equal.size);
    for (std::size_t k = 0; k < equal.size; ++k) levels[i++].mean = std::max(0.0, equal.mean());
  }
  return pooled;
}

// ln((I - I_0) / (I_max - I_0)) = gamma ln(grey / full), least squares through the origin.
double power_law(const std::vector<GreyLevel>& levels) {
  double product = 0;
  double squares = 0;
  const double span = levels.back().mean - levels.front().mean;
  for (const GreyLevel& level : levels) {
    const double part = (level.mean - levels.front().mean) / span;
    const double x = std::log(level.grey / levels.back().grey);
    if (!(part > 0.02) || level.grey <= 0) continue;  // near the dark the logarithm is all noise
    product += x * std::log(part);
    squares += x * x;
  }
  return squares > 0 ? product / squares : 1;
}

}  // namespace

ResponseFit fit_response(std::span<const PhotodiodeReading> readings, double dark, const std::string& source) {
  ResponseFit fit;
  std::vector<GreyLevel> levels = averaged(readings, dark, fit.noise);
  check(levels, fit.noise, source);
  fit.pooled = pool(levels);
  fit.table.source = source;
  for (const GreyLevel& level : levels) {
    fit.table.grey.push_back(level.grey);
    fit.table.intensity.push_back(level.mean);
  }
  fit.contrast =
      levels.front().mean > 0 ? levels.back().mean / levels.front().mean : std::numeric_limits<double>::infinity();
  fit.gamma = power_law(levels);
  return fit;
}

}  // namespace vam::resin

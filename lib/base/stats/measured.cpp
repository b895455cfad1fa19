// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/stats/measured.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "base/index.hpp"
#include "base/stats/distributions.hpp"
#include "base/stats/line.hpp"

namespace vam::stats {

double few_readings_factor(int freedom) { return stats::student_quantile(0.05, std::max(freedom, 1)) / 1.959964; }

double few_parts_factor(const std::vector<double>& parts) {
  double sum = 0;
  double squares = 0;
  for (const double part : parts) {
    sum += part;
    squares += part * part;
  }
  return squares > 0 ? few_readings_factor(floor_int(sum * sum / squares)) : 1.0;
}

Measured mean_of(const std::vector<double>& readings) {
  const auto n = static_cast<double>(readings.size());
  double mean = 0;
  for (const double reading : readings) mean += reading / n;
  double square = 0;
  for (const double reading : readings) square += (reading - mean) * (reading - mean);
  return {mean, std::sqrt(square / (n - 1) / n) * few_readings_factor(count_of(readings) - 1), count_of(readings)};
}

Measured weighted_mean(const std::vector<Measured>& parts) {
  double weights = 0;
  Measured mean;
  for (const auto& part : parts) {
    const double weight = 1 / (part.sigma * part.sigma);
    mean.value += weight * part.value;
    mean.n += part.n;
    weights += weight;
  }
  mean.value /= weights;
  double chi = 0;
  for (const auto& part : parts) chi += std::pow((part.value - mean.value) / part.sigma, 2);
  const double excess = parts.size() > 1 ? chi / static_cast<double>(parts.size() - 1) : 1;
  mean.sigma = std::sqrt(std::max(1.0, excess) / weights);
  return mean;
}

WeightedLine weighted_line(const std::vector<double>& x, const std::vector<Measured>& y) {
  std::vector<double> values, weights;
  int n = 0;
  for (const Measured& one : y) {
    values.push_back(one.value);
    weights.push_back(1 / (one.sigma * one.sigma));
    n += one.n;
  }
  const Line line = straight_line(x, values, weights);
  double chi = 0;
  for (std::size_t i = 0; i < x.size(); ++i) chi += weights[i] * std::pow(values[i] - line.at(x[i]), 2);
  const double excess = x.size() > 2 ? std::max(1.0, chi / static_cast<double>(x.size() - 2)) : 1;
  const double variance = excess / line.spread;
  return {{line.at(0), std::sqrt(excess / line.weight + variance * line.mean_x * line.mean_x), n},
          {line.slope, std::sqrt(variance), n}};
}

Measured lean_deg(const Measured& slope, double pitch) {
  const double rise = slope.value * pitch;
  return {std::atan(rise) * deg_per_rad, slope.sigma * pitch / (1 + rise * rise) * deg_per_rad, slope.n};
}

}  // namespace vam::stats

// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/wobble.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/text/text.hpp"

namespace vam::metrology {

namespace {

constexpr std::size_t terms = 3;  // mean, a, b

void require_round(const std::vector<double>& angle_deg, const std::string& subject) {
  const double gap_deg = widest_gap_deg(angle_deg);
  if (gap_deg < 180 - 1e-6) return;
  throw Error{Fault::data, subject + ": " + std::to_string(angle_deg.size()) + " stage angles leave a gap of " +
                               format_number(gap_deg, 4) +
                               " degrees, so that axis and wobble cannot be distinguished; "
                               "measure at 0, 90, 180 and 270"};
}

}  // namespace

double widest_gap_deg(std::vector<double> angles_deg) {
  for (double& angle : angles_deg) angle -= 360 * std::floor(angle / 360);
  std::sort(angles_deg.begin(), angles_deg.end());
  double gap_deg = angles_deg.empty() ? 360 : angles_deg.front() + 360 - angles_deg.back();
  for (std::size_t i = 1; i < angles_deg.size(); ++i) gap_deg = std::max(gap_deg, angles_deg[i] - angles_deg[i - 1]);
  return gap_deg;
}

Wobble wobble_of(const stats::Measured& mean, const stats::Measured& a, const stats::Measured& b) {
  Wobble out;
  out.mean = mean;
  const double radius = std::max(std::hypot(a.value, b.value), 1e-300);
  const double phase_deg = std::atan2(b.value, a.value) * deg_per_rad;
  const double along = std::hypot(a.value * a.sigma, b.value * b.sigma) / radius;
  const double across = std::hypot(b.value * a.sigma, a.value * b.sigma) / radius;
  out.radius = {radius, along, a.n};
  // No direction is known better than any: the phase of a circle as small as its sigma.
  out.phase_deg = {phase_deg < 0 ? phase_deg + 360 : phase_deg, std::min(across / radius * deg_per_rad, 180.0), a.n};
  return out;
}

Wobble find_wobble(const std::vector<double>& angle_deg, const std::vector<stats::Measured>& values,
                   const std::string& subject) {
  require_round(angle_deg, subject);
  std::vector<double> rows;
  for (const double angle : angle_deg) {
    const double theta = angle * rad_per_deg;
    rows.insert(rows.end(), {1, std::cos(theta), std::sin(theta)});
  }
  // The fit is linear: what a reading of 1 at one angle gives is its weight in each of the terms.
  std::vector<double> fitted(terms);
  std::array<double, terms> variance{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::vector<double> one(values.size());
    one[i] = 1;
    const auto weight = stats::linear_fit(rows, terms, one);
    for (std::size_t k = 0; k < terms; ++k) {
      fitted[k] += weight[k] * values[i].value;
      variance[k] += std::pow(weight[k] * values[i].sigma, 2);
    }
  }
  double chi_square = 0;
  const auto course = stats::sums_of(rows, fitted);
  for (std::size_t i = 0; i < values.size(); ++i) {
    chi_square += std::pow((values[i].value - course[i]) / std::max(values[i].sigma, 1e-12), 2);
  }
  const auto freedom = static_cast<double>(values.size() - terms);
  const double wider = freedom > 0 ? std::sqrt(std::max(chi_square / freedom, 1.0)) : 1;
  const auto n = count_of(values);
  const auto measured = [&](std::size_t k) { return stats::Measured{fitted[k], wider * std::sqrt(variance[k]), n}; };
  return wobble_of(measured(0), measured(1), measured(2));
}

}  // namespace vam::metrology

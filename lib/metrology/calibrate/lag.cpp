// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/lag.hpp"

#include <cmath>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/stats/line.hpp"
#include "base/text/text.hpp"

namespace vam::metrology {

namespace {
constexpr double needed_phase_sigma_deg = 10;
}

double turning_speed_deg_s(const std::vector<double>& time_s, const std::vector<double>& angle_deg) {
  const stats::Line line = stats::straight_line(time_s, angle_deg);
  if (line.spread > 0) return line.slope;
  throw Error{Fault::data, "lag: the frames have no times; capture them with vam-capture --follow"};
}

std::vector<double> phase_weights(const std::vector<double>& angle_deg, double phase_deg) {
  std::vector<double> weight;
  double sum = 0;
  for (const double angle : angle_deg) {
    weight.push_back(std::pow(std::sin((angle - phase_deg) * rad_per_deg), 2));
    sum += weight.back();
  }
  for (double& part : weight) part /= sum;
  return weight;
}

stats::Measured camera_lag_ms(const CameraAxis& forwards, double forwards_deg_s, const CameraAxis& backwards,
                              double backwards_deg_s) {
  for (const double speed_deg_s : {forwards_deg_s, backwards_deg_s}) {
    if (speed_deg_s > 0) continue;
    throw Error{Fault::data,
                "lag: the stage rotates at " + format_number(speed_deg_s, 4) +
                    " deg/s; capture one turn with vam-stage spin --direction 1 and one with --direction -1"};
  }
  for (const auto* turn : {&forwards, &backwards}) {
    if (turn->phase_deg.sigma <= needed_phase_sigma_deg) continue;
    const double sigma_deg = turn->phase_deg.sigma;
    throw Error{Fault::data, "lag: no object turns with the stage: the phase of its circle " +
                                 (std::isfinite(sigma_deg)
                                      ? "has a standard deviation of " + format_number(sigma_deg, 3) + " degrees"
                                      : std::string("cannot be determined")) +
                                 "; place a bead off the axis"};
  }
  const double both_deg = std::remainder(forwards.phase_deg.value + backwards.phase_deg.value, 360.0);
  const double sigma_deg = std::hypot(forwards.phase_deg.sigma, backwards.phase_deg.sigma);
  const double ms_per_deg = 1e3 / (forwards_deg_s + backwards_deg_s);
  return {ms_per_deg * both_deg, ms_per_deg * sigma_deg, forwards.phase_deg.n + backwards.phase_deg.n};
}

}  // namespace vam::metrology

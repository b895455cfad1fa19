// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/latency.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/text.hpp"

namespace vam::metrology {

namespace {

constexpr double earliest_s = -0.02;  // a camera that stamps late makes the light seem early
constexpr double coarse_s = 0.0005;
constexpr int trials = 640;  // up to 0.3 s

// The part of each exposure during which the light, delayed, was on.
std::vector<double> lit_parts(const BlinkScan& scan, double latency_s) {
  std::vector<double> parts;
  for (const double begin_s : scan.begin_s) {
    double lit_s = 0;
    for (const auto& [on_s, off_s] : scan.lit_s) {
      lit_s +=
          std::max(0.0, std::min(off_s + latency_s, begin_s + scan.exposure_s) - std::max(on_s + latency_s, begin_s));
    }
    parts.push_back(lit_s / scan.exposure_s);
  }
  return parts;
}

struct Line {
  double ground = 0;
  double light = 0;
  double misfit = 0;
};

Line straight(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0;
  double sy = 0;
  double sxx = 0;
  double sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    sxy += x[i] * y[i];
  }
  const double determinant = n * sxx - sx * sx;
  Line line;
  line.light = determinant > 1e-9 ? std::max((n * sxy - sx * sy) / determinant, 0.0) : 0;
  line.ground = (sy - line.light * sx) / n;
  for (std::size_t i = 0; i < x.size(); ++i) line.misfit += std::pow(y[i] - line.ground - line.light * x[i], 2);
  return line;
}

}  // namespace

Latency measure_latency(const BlinkScan& scan) {
  if (scan.begin_s.size() < 8 || scan.lit_s.empty()) {
    throw Error{Fault::data, "latency: " + std::to_string(scan.begin_s.size()) + " frames and " +
                                 std::to_string(scan.lit_s.size()) + " flashes; at least 8 and 1 are needed"};
  }
  double best_s = 0;
  Line best;
  best.misfit = INFINITY;
  for (int i = 0; i <= trials; ++i) {
    const double trial_s = earliest_s + i * coarse_s;
    const Line line = straight(lit_parts(scan, trial_s), scan.light);
    if (line.misfit < best.misfit) {
      best = line;
      best_s = trial_s;
    }
  }
  const auto parts = lit_parts(scan, best_s);
  const double scatter = std::sqrt(best.misfit / static_cast<double>(parts.size()));
  if (!(best.light > 5 * scatter)) {
    throw Error{Fault::data, "latency: the blinking screen is not visible to the camera; light " +
                                 format_number(best.light, 3) + ", scatter " + format_number(scatter, 3)};
  }
  const auto partial =
      std::count_if(parts.begin(), parts.end(), [](double part) { return part > 0.02 && part < 0.98; });
  if (partial < 2) {
    throw Error{
        Fault::data,
        "latency: no frame was exposed across a flip; blink with a period that is not a multiple of the frame period"};
  }
  const auto residuals = [&](const std::vector<double>& p) {
    auto out = lit_parts(scan, 1e-3 * p[0]);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = scan.light[i] - p[1] - p[2] * out[i];
    return out;
  };
  const double step = 1e-3 * best.light;
  const auto fit = stats::fit_curve(residuals, {1e3 * best_s, best.ground, best.light}, {0.02, step, step}, "latency");
  return {fit.measured(0), best.light / std::max(scatter, 1e-12)};
}

}  // namespace vam::metrology

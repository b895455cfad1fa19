// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/latency.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "base/error.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/stats/median.hpp"
#include "base/text/text.hpp"
#include "metrology/calibrate/private/blinks.hpp"

namespace vam::metrology {

namespace {

constexpr double earliest_s = -0.02;  // a camera that stamps late makes the light seem early
constexpr double coarse_s = 0.5 * rise_s;
constexpr std::size_t steps = 640;      // up to 0.3 s
constexpr double clearly = 3;           // standard deviations
constexpr double rise_sigma_ms = 0.03;  // of the unknown course of the light while it comes: by 1,000 simulated scans

double at_step(std::size_t i) { return earliest_s + coarse_s * static_cast<double>(i); }

struct Line {
  double ground = 0;
  double light = 0;
  double misfit = 0;
  std::vector<double> square;  // of each residual
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
  line.square.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double residual = y[i] - line.ground - line.light * x[i];
    line.square.push_back(residual * residual);
    line.misfit += line.square.back();
  }
  return line;
}

struct Valley {
  double latency_s = 0;
  Line line;
};

// The lowest misfit between two latencies, by golden section.
template <class Misfit>
double lowest(const Misfit& misfit, double low, double high) {
  constexpr double golden = 0.6180339887498949;
  double a = high - golden * (high - low);
  double b = low + golden * (high - low);
  double at_a = misfit(a);
  double at_b = misfit(b);
  while (high - low > 1e-6) {
    const bool left = at_a < at_b;
    (left ? high : low) = left ? b : a;
    (left ? b : a) = left ? a : b;
    (left ? at_b : at_a) = left ? at_a : at_b;
    (left ? a : b) = left ? high - golden * (high - low) : low + golden * (high - low);
    (left ? at_a : at_b) = misfit(left ? a : b);
  }
  return 0.5 * (low + high);
}

// Every valley of the misfit from one end to the other, and beside them its course at coarse steps.
struct Landscape {
  std::vector<double> misfit;  // a step beyond either end: infinite
  std::vector<Valley> valleys;
};

Landscape survey(const BlinkScan& scan, const Blinks& blinks) {
  const auto line_at = [&](double latency_s) { return straight(blinks.lit_parts(latency_s), scan.light); };
  constexpr double beyond = std::numeric_limits<double>::infinity();
  Landscape all;
  all.misfit.push_back(beyond);
  for (std::size_t i = 0; i <= steps; ++i) all.misfit.push_back(line_at(at_step(i)).misfit);
  all.misfit.push_back(beyond);
  for (std::size_t i = 0; i <= steps; ++i) {
    if (all.misfit[i + 1] > all.misfit[i] || all.misfit[i + 1] > all.misfit[i + 2]) continue;
    const auto misfit_at = [&](double latency_s) { return line_at(latency_s).misfit; };
    const double latency_s = lowest(misfit_at, at_step(i) - coarse_s, at_step(i) + coarse_s);
    all.valleys.push_back({latency_s, line_at(latency_s)});
  }
  return all;
}

// The deepest but for those in the best one's own: where blinks explain more than half of what the best explain.
const Valley* runner_up(const Landscape& all, const Valley& best, double unexplained) {
  const double rim = 0.5 * (best.line.misfit + unexplained);
  auto low = static_cast<std::size_t>(std::lround((best.latency_s - earliest_s) / coarse_s)) + 1;
  auto high = low;
  while (all.misfit[low] < rim) --low;
  while (all.misfit[high] < rim) ++high;
  const Valley* second = nullptr;
  for (const Valley& valley : all.valleys) {
    const double step = (valley.latency_s - earliest_s) / coarse_s + 1;
    const bool own = step >= static_cast<double>(low) && step <= static_cast<double>(high);
    if (!own && (second == nullptr || valley.line.misfit < second->line.misfit)) second = &valley;
  }
  return second;
}

// By how many standard deviations of the difference the other fits worse [VUO89].
double worse_by(const Line& other, const Line& best) {
  const auto n = static_cast<double>(best.square.size());
  const double mean = (other.misfit - best.misfit) / n;
  double variance = 0;
  for (std::size_t i = 0; i < best.square.size(); ++i) {
    variance += std::pow(other.square[i] - best.square[i] - mean, 2) / n;
  }
  return mean / std::sqrt(std::max(variance / n, 1e-300));
}

void refuse_unseen(const BlinkScan& scan, const Stretch& open) {
  if (open.width_s() <= rise_s) return;
  std::vector<double> period_s;
  for (std::size_t n = 0; n + 1 < scan.begin_s.size(); ++n) period_s.push_back(scan.begin_s[n + 1] - scan.begin_s[n]);
  // Exposures begin at moments of the screen's frame that are so far apart; the golden section of that walks over all.
  const double apart_s = scan.exposure_s + open.width_s();
  const double fps = 1 / (stats::median(period_s) + 0.382 * apart_s);
  throw Error{Fault::data,
              "latency: all from " + format_number(1e3 * open.from_s, 4) + " to " + format_number(1e3 * open.to_s, 4) +
                  " ms fit, as no exposure of " + format_number(1e3 * scan.exposure_s, 4) +
                  " ms meets a change of the screen there: camera and screen keep step; expose for at least " +
                  format_number(1e3 * apart_s, 4) + " ms, or capture at --fps " + format_number(fps, 4)};
}

}  // namespace

Latency measure_latency(const BlinkScan& scan) {
  if (scan.begin_s.size() < 8 || scan.lit_s.empty()) {
    throw Error{Fault::data, "latency: " + std::to_string(scan.begin_s.size()) + " frames and " +
                                 std::to_string(scan.lit_s.size()) + " flashes; at least 8 and 1 are needed"};
  }
  const Blinks blinks(scan);
  const Landscape all = survey(scan, blinks);
  const Valley& best = *std::min_element(all.valleys.begin(), all.valleys.end(), [](const Valley& a, const Valley& b) {
    return a.line.misfit < b.line.misfit;
  });
  const double scatter = std::sqrt(best.line.misfit / static_cast<double>(scan.light.size()));
  if (!(best.line.light > 5 * scatter)) {
    throw Error{Fault::data, "latency: the blinking screen is not visible to the camera; light " +
                                 format_number(best.line.light, 3) + ", scatter " + format_number(scatter, 3)};
  }
  const Stretch open = unseen_stretch(scan, best.latency_s);
  refuse_unseen(scan, open);
  const double unexplained = straight(std::vector<double>(scan.light.size()), scan.light).misfit;
  const Valley* second = runner_up(all, best, unexplained);
  if (second != nullptr && !(worse_by(second->line, best.line) >= clearly)) {
    throw Error{Fault::data, "latency: " + format_number(1e3 * best.latency_s, 4) + " and " +
                                 format_number(1e3 * second->latency_s, 4) + " ms fit alike (the other worse by " +
                                 format_number(worse_by(second->line, best.line), 2) + " standard deviations, below " +
                                 format_number(clearly) +
                                 "); show vam-project --pattern blink, which repeats nothing, and capture more frames"};
  }
  const auto residuals = [&](const std::vector<double>& p) {
    auto out = blinks.lit_parts(1e-3 * p[0]);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = scan.light[i] - p[1] - p[2] * out[i];
    return out;
  };
  const double step = 1e-3 * best.line.light;
  auto found = stats::fit_curve(residuals, {1e3 * best.latency_s, best.line.ground, best.line.light},
                                {0.02, step, step}, "latency")
                   .measured(0);
  found.sigma = std::hypot(found.sigma, 1e3 * open.width_s() / std::sqrt(12), rise_sigma_ms);
  return {found, best.line.light / std::max(scatter, 1e-12)};
}

}  // namespace vam::metrology

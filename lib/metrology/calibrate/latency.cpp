// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/latency.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include "base/error.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/stats/line.hpp"
#include "base/stats/median.hpp"
#include "base/text/text.hpp"
#include "metrology/calibrate/private/blinks.hpp"

namespace vam::metrology {

namespace {

constexpr double earliest_s = -0.02;  // a camera that stamps late makes the light seem early
constexpr double coarse_s = 0.5 * unsure_s;
constexpr std::size_t steps = 640;      // up to 0.3 s
constexpr double clearly = 3;           // standard deviations
constexpr double fast_s = 0.00025;      // time constant of a light that is taken to come at once
constexpr double rise_sigma_ms = 0.03;  // of the course of the light while it comes: by 1,000 simulated scans

double at_step(std::size_t i) { return earliest_s + coarse_s * static_cast<double>(i); }

struct Line {
  double ground = 0;
  double light = 0;
  double misfit = 0;
  std::vector<double> square;  // of each residual
};

Line straight(const std::vector<double>& x, const std::vector<double>& y) {
  const stats::Line fit = stats::straight_line(x, y);
  Line line;
  line.light = static_cast<double>(x.size()) * fit.spread > 1e-9 ? std::max(fit.slope, 0.0) : 0;
  line.ground = fit.mean_y - line.light * fit.mean_x;
  line.square.reserve(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double residual = y[i] - line.ground - line.light * x[i];
    line.square.push_back(residual * residual);
    line.misfit += line.square.back();
  }
  return line;
}

struct Valley {
  double rise_s = 0;  // time constant of the light
  double latency_s = 0;
  Line line;
};

// Where the misfit between two values is lowest; to 2e-6 of itself, and 5e-7.
template <class Misfit>
double lowest(const Misfit& misfit, double low, double high) {
  constexpr int bits = 20;
  return boost::math::tools::brent_find_minima(misfit, low, high, bits).first;
}

Valley valley_between(const BlinkScan& scan, double rise_s, double low_s, double high_s) {
  const Blinks blinks(scan, rise_s);
  const auto line_at = [&](double latency_s) { return straight(blinks.lit_parts(latency_s), scan.light); };
  const double latency_s = lowest([&](double at_s) { return line_at(at_s).misfit; }, low_s, high_s);
  return {rise_s, latency_s, line_at(latency_s)};
}

// Every valley of the misfit from one end to the other, and the misfit at coarse steps.
struct MisfitCurve {
  std::vector<double> misfit;  // a step beyond either end: infinite
  std::vector<Valley> valleys;
};

MisfitCurve survey(const BlinkScan& scan, double rise_s) {
  constexpr double beyond = std::numeric_limits<double>::infinity();
  const Blinks blinks(scan, rise_s);
  MisfitCurve all{{beyond}, {}};
  for (std::size_t i = 0; i <= steps; ++i) {
    all.misfit.push_back(straight(blinks.lit_parts(at_step(i)), scan.light).misfit);
  }
  all.misfit.push_back(beyond);
  for (std::size_t i = 0; i <= steps; ++i) {
    if (all.misfit[i + 1] > all.misfit[i] || all.misfit[i + 1] > all.misfit[i + 2]) continue;
    all.valleys.push_back(valley_between(scan, rise_s, at_step(i) - coarse_s, at_step(i) + coarse_s));
  }
  return all;
}

Valley deepest(const MisfitCurve& all) {
  return *std::min_element(all.valleys.begin(), all.valleys.end(),
                           [](const Valley& a, const Valley& b) { return a.line.misfit < b.line.misfit; });
}

// How much worse the other fits, in standard deviations of the difference [VUO89].
double worse_by(const Line& other, const Line& best) {
  const auto n = static_cast<double>(best.square.size());
  const double mean = (other.misfit - best.misfit) / n;
  double variance = 0;
  for (std::size_t i = 0; i < best.square.size(); ++i) {
    variance += std::pow(other.square[i] - best.square[i] - mean, 2) / n;
  }
  return mean / std::sqrt(std::max(variance / n, 1e-300));
}

// The misfit by the best of a few time constants that are far apart; a longer one only where it is clearly better.
MisfitCurve survey_all(const BlinkScan& scan) {
  MisfitCurve best = survey(scan, fast_s);
  for (const double rise_s : {0.002, 0.008}) {
    MisfitCurve other = survey(scan, rise_s);
    if (worse_by(deepest(best).line, deepest(other).line) >= clearly) best = std::move(other);
  }
  return best;
}

// The valley of the time constant that fits best about that of the curve.
Valley refined(const BlinkScan& scan, const MisfitCurve& all) {
  Valley rough = deepest(all);
  if (rough.rise_s == fast_s) return rough;
  const auto valley = [&](double rise) {
    const double about_s = std::abs(rise - rough.rise_s) + coarse_s;
    return valley_between(scan, rise, rough.latency_s - about_s, rough.latency_s + about_s);
  };
  return valley(std::exp(lowest([&](double log_rise) { return valley(std::exp(log_rise)).line.misfit; },
                                std::log(rough.rise_s / 4), std::log(rough.rise_s * 4))));
}

// How far the latency goes with time constants that do not fit clearly worse: short exposures see little of the course
// of the light.
double unsettled_s(const BlinkScan& scan, const Valley& best) {
  double farthest_s = 0;
  for (const double rise_s : {fast_s, 0.001, 0.002, 0.004, 0.008}) {
    const double about_s = rise_s + coarse_s;
    const Valley other = valley_between(scan, rise_s, best.latency_s - about_s, best.latency_s + about_s);
    if (worse_by(other.line, best.line) >= clearly) continue;
    farthest_s = std::max(farthest_s, std::abs(other.latency_s - best.latency_s));
  }
  return farthest_s;
}

// The deepest but for those in the best one's own: where blinks explain more than half of what the best explain.
const Valley* runner_up(const MisfitCurve& all, const Valley& best, double unexplained) {
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

void refuse_unseen(const BlinkScan& scan, const Stretch& open) {
  if (open.width_s() <= unsure_s) return;
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
  const MisfitCurve all = survey_all(scan);
  const Valley best = refined(scan, all);
  const Blinks blinks(scan, best.rise_s);
  const double scatter = std::sqrt(best.line.misfit / static_cast<double>(scan.light.size()));
  if (!(best.line.light > 5 * scatter)) {
    throw Error{Fault::data, "latency: the blinking screen is not visible to the camera; light " +
                                 format_number(best.line.light, 3) + ", scatter " + format_number(scatter, 3)};
  }
  const Stretch open = unseen_stretch(scan, best.latency_s, best.rise_s);
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
  const double alike_ms = 1e3 * std::hypot(open.width_s() / 2, unsettled_s(scan, best));  // on either side
  found.sigma = std::hypot(found.sigma, alike_ms / std::sqrt(3), rise_sigma_ms);
  return {found, best.line.light / std::max(scatter, 1e-12)};
}

}  // namespace vam::metrology

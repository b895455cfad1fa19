// SPDX-License-Identifier: GPL-3.0-or-later
// The sum of parallel rays at a height of a body is the same in all directions [HEL65]. The views' own rays are not
// parallel: their sum changes smoothly over the turn. So neighbouring views are compared
// with this smooth course, and the course itself is found from the parallel rays that are made of the views [physics
// §8].
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/stats/median.hpp"
#include "metrology/ost/cleaning_report.hpp"
#include "metrology/ost/private/angle_grid.hpp"
#include "metrology/ost/private/ost_state.hpp"

namespace vam::metrology {

namespace {

constexpr int harmonics = 4;
constexpr std::size_t terms = 2 * harmonics + 1;
using Readings = std::vector<double>;  // one a view or angle

std::vector<double> harmonics_at(std::span<const double> angles_rad) {
  std::vector<double> rows;
  for (const double angle : angles_rad) {
    rows.push_back(1);
    for (int n = 1; n <= harmonics; ++n) rows.insert(rows.end(), {std::cos(n * angle), std::sin(n * angle)});
  }
  return rows;
}

// A row whose course passes zero gives no ratio.
bool usable(const Readings& intensity) {
  return std::all_of(intensity.begin(), intensity.end(), [](double v) { return std::isfinite(v) && v > 0; });
}

double total(const float* row, int width) {
  double sum = 0;
  for (int t = 0; t < width; ++t) sum += static_cast<double>(row[t]);
  return sum;
}

// For each view or angle the median over the heights: what passes in a few of them does not count.
Readings median_of(const std::vector<Readings>& heights) {
  Readings out(heights.front().size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::vector<double> here;
    for (const auto& height : heights) here.push_back(height[i]);
    out[i] = stats::median(std::move(here));
  }
  return out;
}

// Brightness of each view, from the totals of its rows: [height][view].
Readings apart_from_course(const std::vector<Readings>& totals, std::span<const double> angles_rad) {
  constexpr int rounds = 3;  // a view out of line pulls the course towards itself, less each time
  const std::vector<double> rows = harmonics_at(angles_rad);
  Readings intensity(angles_rad.size(), 1.0);
  for (int round = 0; round < rounds; ++round) {
    std::vector<Readings> ratios(totals.size());
    parallel_for(count_of(totals), [&](int k) {
      Readings steady = totals[k];
      for (std::size_t i = 0; i < steady.size(); ++i) steady[i] /= intensity[i];
      ratios[k] = stats::sums_of(rows, stats::linear_fit(rows, terms, steady));
      for (std::size_t i = 0; i < steady.size(); ++i) ratios[k][i] = totals[k][i] / ratios[k][i];
    });
    intensity = median_of(ratios);
  }
  return intensity;
}

std::vector<Readings> view_totals(const std::vector<Image>& level) {
  std::vector<Readings> totals(level.front().height, Readings(level.size()));
  for (std::size_t i = 0; i < level.size(); ++i) {
    for (int k = 0; k < level[i].height; ++k) totals[k][i] = total(level[i].row(k), level[i].width);
  }
  return totals;
}

// Totals of parallel rays over their mean, of each height that shows all of the print: [height][angle].
std::vector<Readings> parallel_totals(const std::vector<Image>& sinograms) {
  constexpr double outside = 0.01;  // of all light, in the outer fiftieths of the columns
  std::vector<Readings> all;
  for (const Image& s : sinograms) {
    const int edge = std::max(1, s.width / 50);
    Readings ratios(s.height);
    double sum = 0;
    double outer = 0;
    for (int a = 0; a < s.height; ++a) {
      sum += ratios[a] = total(s.row(a), s.width);
      outer += total(s.row(a), edge) + total(s.row(a) + s.width - edge, edge);
    }
    if (!(sum > 0) || outer > outside * sum) continue;
    for (double& value : ratios) value *= s.height / sum;
    all.push_back(std::move(ratios));
  }
  return all;
}

// A growing print scatters more from view to view, smoothly: the cubic fit to the values in their order.
Readings smooth_course(const Readings& values) {
  constexpr std::size_t powers = 4;
  std::vector<double> rows;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double time = 2.0 * static_cast<double>(i) / static_cast<double>(values.size() - 1) - 1;
    double power = 1;
    for (std::size_t n = 0; n < powers; ++n, power *= time) rows.push_back(power);
  }
  return stats::sums_of(rows, stats::linear_fit(rows, powers, values));
}

// Some heights of the print, not those where it ends.
std::vector<double> some_of(const std::vector<double>& heights) {
  constexpr std::size_t most = 24;
  std::vector<double> some;
  const std::size_t step = heights.size() / most + 1;
  for (std::size_t i = heights.size() / 10; i < heights.size() - heights.size() / 10; i += step) {
    some.push_back(heights[i]);
  }
  return some;
}

}  // namespace

Flicker OstReconstructor::State::flicker(std::span<const CameraView> views, const Image& mean,
                                         std::span<const double> angles_deg, double background) const {
  if (absorption_per_mm > 0 || !options.refraction || views.size() < 3 * terms) return {};
  const RowOfHeight map(eye);
  const auto heights_mm = some_of(print_heights(mean, map, eye, grid, std::numeric_limits<std::size_t>::max()));
  if (heights_mm.empty()) return {};
  auto level = level_views(views, LevelRows(map, eye.camera.columns, eye.rows, heights_mm, axis));
  make_steady(level, background, {});
  const std::vector<double> directions_rad = part_angles_rad(angles_deg);
  Readings intensity = apart_from_course(view_totals(level), directions_rad);
  if (!usable(intensity)) return {};

  make_steady(level, 0, intensity);
  const Turns turns(angles_deg);
  const auto totals = parallel_totals(virtual_sinograms(camera_sinograms(level, turns), heights_mm));
  if (totals.empty()) return {};
  std::vector<double> even_rad;
  for (int a = 0; a < turns.angles(); ++a) even_rad.push_back(2 * std::numbers::pi * a / turns.angles());
  const auto course =
      stats::sums_of(harmonics_at(directions_rad), stats::linear_fit(harmonics_at(even_rad), terms, median_of(totals)));
  for (std::size_t i = 0; i < intensity.size(); ++i) intensity[i] *= course[i];

  const double usual = stats::median(intensity);
  for (double& value : intensity) value /= usual;
  const Readings growth = options.growing ? smooth_course(intensity) : Readings(intensity.size(), 1.0);
  if (!usable(intensity) || !usable(growth)) return {};
  double squares = 0;
  for (std::size_t i = 0; i < intensity.size(); ++i) {
    const double off = intensity[i] / growth[i] - 1;
    squares += off * off / static_cast<double>(intensity.size());
  }
  Flicker found{100 * std::sqrt(squares), {}};
  if (options.growing || found.percent >= removed_flicker_percent) found.intensity = std::move(intensity);
  return found;
}

}  // namespace vam::metrology

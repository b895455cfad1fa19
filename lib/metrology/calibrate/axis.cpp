// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/axis.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/text/text.hpp"
#include "metrology/calibrate/private/half_maximum.hpp"
#include "metrology/calibrate/wobble.hpp"

namespace vam::metrology {

namespace {

enum : std::size_t { axis, cos_1, sin_1, cos_2, sin_2, count };

void require_full_turn(const std::vector<double>& angle_deg) {
  const double gap_deg = widest_gap_deg(angle_deg);
  if (gap_deg <= 90) return;
  throw Error{Fault::data, "axis: " + std::to_string(angle_deg.size()) + " frames leave a gap of " +
                               format_number(gap_deg, 4) + " degrees; capture a whole turn"};
}

template <class Column>
std::vector<double> columns_of(const Image& frame, int bands, const Column& column) {
  std::vector<double> columns;
  for (int b = 0; b < bands; ++b) {
    const auto extent =
        half_maximum(column_profile(frame, b * frame.height / bands, std::max((b + 1) * frame.height / bands, b + 1)));
    columns.push_back(extent ? column(*extent) : NAN);
  }
  return columns;
}

stats::CurveFit fit_band(const TurnScan& scan, const std::vector<double>& middle) {
  const auto residuals = [&](const std::vector<double>& p) {
    std::vector<double> out;
    for (std::size_t i = 0; i < middle.size(); ++i) {
      if (!std::isfinite(middle[i])) continue;
      const double theta = scan.angle_deg[i] * rad_per_deg;
      out.push_back(middle[i] - p[axis] - p[cos_1] * std::cos(theta) - p[sin_1] * std::sin(theta) -
                    p[cos_2] * std::cos(2 * theta) - p[sin_2] * std::sin(2 * theta));
    }
    return out;
  };
  return stats::fit_curve(residuals, std::vector<double>(count), std::vector<double>(count, 1e-3), "axis: middles");
}

}  // namespace

std::vector<double> bright_middles(const Image& frame, int bands) {
  return columns_of(frame, bands, [](const Extent& extent) { return extent.middle(); });
}

std::vector<double> bright_centroids(const Image& frame, int bands) {
  return columns_of(frame, bands, [](const Extent& extent) { return extent.centroid; });
}

CameraAxis find_camera_axis(const TurnScan& scan) {
  require_full_turn(scan.angle_deg);
  CameraAxis out;
  std::vector<double> row;
  std::vector<stats::Measured> column;
  std::vector<stats::Measured> a;
  std::vector<stats::Measured> b;
  const auto bands = static_cast<double>(scan.middle.size());
  for (std::size_t i = 0; i < scan.middle.size(); ++i) {
    const auto seen = std::count_if(scan.middle[i].begin(), scan.middle[i].end(),
                                    [](double middle) { return std::isfinite(middle); });
    if (4 * seen < 3 * static_cast<long>(scan.angle_deg.size())) continue;
    const stats::CurveFit fit = fit_band(scan, scan.middle[i]);
    row.push_back(((static_cast<double>(i) + 0.5) / bands - 0.5) * scan.rows);
    column.push_back(fit.measured(axis));
    a.push_back(fit.measured(cos_1));
    b.push_back(fit.measured(sin_1));
  }
  if (column.empty()) {
    throw Error{Fault::data,
                "axis: no height has one bright object in 3/4 of " + std::to_string(scan.angle_deg.size()) + " frames"};
  }
  out.bands = count_of(column);
  out.column = column.front();
  if (out.bands > 1) {
    const stats::WeightedLine line = stats::weighted_line(row, column);
    out.column = line.at_zero;
    out.tilt_deg = stats::lean_deg(line.slope, 1);
  }
  const Wobble wobble = wobble_of(out.column, stats::weighted_mean(a), stats::weighted_mean(b));
  out.wobble_px = wobble.radius;
  out.phase_deg = wobble.phase_deg;
  return out;
}

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/axis.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <vector>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/stats/median.hpp"
#include "metrology/ost/private/heights.hpp"
#include "metrology/ost/private/line_ranges.hpp"

namespace vam::metrology {

namespace {

// White noise between pixels has less variance than on them, so that its energy would draw the axis to where it is
// least; blurred by this, it is nearly the same everywhere.
constexpr double axis_blur_px = 2;

Image blurred(const Image& image) {
  Image out = image;
  cv::Mat pixels(out.height, out.width, CV_32F, out.values.data());
  cv::GaussianBlur(pixels, pixels, {}, axis_blur_px, axis_blur_px, cv::BORDER_REPLICATE);
  return out;
}

// Turned about (column, middle row) so that the axis runs straight down its column.
Image straightened(const Image& image, const AxisPose& axis) {
  if (axis.tilt_rad == 0) return image;
  return LevelRows(image.width, image.height, image.height, axis, [](int, int y) { return y; }).of(image);
}

// Variance that white noise of variance 1 leaves in the difference of two central differences, once blurred.
double blurred_slope_variance() {
  return (1 - std::exp(-1 / (axis_blur_px * axis_blur_px))) / (4 * std::numbers::pi * axis_blur_px * axis_blur_px);
}

// Standard deviation of the noise of a pixel, from second differences along the rows: smooth contents leave little.
double noise_of(const Image& image) {
  std::vector<double> second;
  for (int y = 0; y < image.height; ++y) {
    const float* row = image.row(y);
    for (int x = 1; x + 1 < image.width; ++x)
      second.push_back(static_cast<double>(row[x - 1] - 2 * row[x] + row[x + 1]));
  }
  return second.empty() ? 0.0 : stats::robust_sigma(std::move(second)) / std::sqrt(6.0);
}

// Centre of mass of what stands above the median: right where all of the body is in the image, near it elsewhere.
double start_column(const Image& image) {
  std::vector<double> values(image.values.begin(), image.values.end());
  const double floor = stats::median(values);
  const double high = static_cast<double>(*std::max_element(image.values.begin(), image.values.end()));
  const double least = floor + 0.2 * (high - floor);
  double mass = 0;
  double moment = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto v = static_cast<double>(image(x, y));
      if (v <= least) continue;
      mass += v - floor;
      moment += (v - floor) * x;
    }
  }
  return mass > 0 ? moment / mass : 0.5 * (image.width - 1);
}

// A row between its pixels.
double at(const float* row, int width, double x) {
  const double inside = std::clamp(x, 0.0, width - 1.0);
  const int low = std::min(static_cast<int>(inside), width - 2);
  const double f = inside - low;
  return (1 - f) * static_cast<double>(row[low]) + f * static_cast<double>(row[low + 1]);
}

using Pull = std::array<double, 2>;  // on column and tilt
constexpr int ranges = 16;

/// Weights of residuals: beyond a bound they fall with the distance, as dirt passes there.
struct Bound {
  double residual = 1e300;
  [[nodiscard]] bool holds(double r) const { return std::abs(r) <= residual; }
  [[nodiscard]] double weight(double r) const { return holds(r) ? 1.0 : std::pow(residual / r, 2); }
  /// Derivative of a residual's pull: negative beyond the bound.
  [[nodiscard]] double stiffness(double r) const { return holds(r) ? 1.0 : -weight(r); }
};

// Normal equations of the residuals r = M(c + x, y) - M(c - x, y) in column and tilt. A change of the tilt moves the
// point (x, y) by (y, -x): without the second part a wide body would seem to lean the other way.
struct Normal {
  double cc = 0, ct = 0, tt = 0;
  double cr = 0, tr = 0, rr = 0;
  double stiff_cc = 0, stiff_tt = 0;  // by how much the pulls change with column and tilt
  double noise_cc = 0, noise_tt = 0;  // what slopes of variance 1 add to cc and tt
  long count = 0;
  std::vector<std::vector<SeenLine>> lines{1};
  RangePulls<2, ranges, ranges> pulls{};  // of the ranges of rows and of offsets

  void add(double by_column, double by_tilt, double r, const Bound& bound, Pull& pull) {
    const double weight = bound.weight(r);
    stiff_cc += bound.stiffness(r) * by_column * by_column;
    stiff_tt += bound.stiffness(r) * by_tilt * by_tilt;
    cc += weight * by_column * by_column;
    ct += weight * by_column * by_tilt;
    tt += weight * by_tilt * by_tilt;
    cr += weight * by_column * r;
    tr += weight * by_tilt * r;
    rr += weight * r * r;
    pull[0] += weight * by_column * r;
    pull[1] += weight * by_tilt * r;
  }
};

Normal normal_of(const Image& image, double column, const Bound& bound) {
  Normal normal;
  const double reach = std::min(column, image.width - 1 - column) - 3 * axis_blur_px;
  const double middle = 0.5 * (image.height - 1);
  for (int y = 1; y + 1 < image.height; ++y) {
    const float* rows[3] = {image.row(y - 1), image.row(y), image.row(y + 1)};
    const double along = y - middle;
    auto& pulls = normal.pulls[y * ranges / image.height];
    for (int pixel = 0; pixel + 0.5 < reach; ++pixel) {
      const double x = pixel + 0.5;
      const double right = column + x;
      const double left = column - x;
      const auto m = [&](int row, double where) { return at(rows[row], image.width, where); };
      const double r = m(1, right) - m(1, left);
      const double by_column = 0.5 * (m(1, right + 1) - m(1, right - 1)) - 0.5 * (m(1, left + 1) - m(1, left - 1));
      const double by_row = 0.5 * (m(2, right) - m(0, right)) + 0.5 * (m(2, left) - m(0, left));
      normal.add(by_column, along * by_column - x * by_row, r, bound,
                 pulls[std::min(ranges - 1, static_cast<int>(ranges * x / reach))]);
      normal.noise_cc += 1;
      normal.noise_tt += along * along + x * x;
      ++normal.count;
      normal.lines.front().push_back({by_column * by_column, r});
    }
  }
  return normal;
}

// Variances of column and tilt by how much ranges of rows and of offsets disagree: what is the same in all rows or at
// all offsets errs alike. Both, less what both count; wider where few of them pull. The largest of those of narrow and
// wide ranges: the trail of a bubble that drifts crosses many narrow ones, and errs alike in all of them.
Pull disagreement(const Normal& n, double cc, double tt, double left) {
  Pull most{};
  for (const std::size_t merged : {1, 2, 4}) {
    const auto [rows, offsets, both, few] = range_moves(n.pulls, merged, [&](const Pull& pull) {
      return Pull{(tt * pull[0] - n.ct * pull[1]) / left, (cc * pull[1] - n.ct * pull[0]) / left};
    });
    for (std::size_t u = 0; u < most.size(); ++u)
      most[u] = std::max(most[u], few[u] * few[u] * (rows[u] + offsets[u] - both[u]));
  }
  return most;
}

// Factor by which residuals of low weight that were expected to hold enlarge deviations. For blurred noise, which
// neighbours share, it is never more than 2.45.
double softness(double stiff, double thought) {
  constexpr double most = 2.45;
  return stiff * most > thought ? thought / stiff : most;
}

// Nothing where the image is not symmetric about a column.
std::optional<AxisEstimate> axis_of(const Image& view) {
  if (view.width < 20 || view.height < 4) return std::nullopt;
  AxisEstimate estimate;
  AxisPose& pose = estimate.pose;
  pose.column = start_column(view);
  const double noise2 = std::pow(noise_of(view), 2) * blurred_slope_variance();
  const Image smooth = blurred(view);
  constexpr int steps = 60;
  constexpr double farthest_rad = 30 * rad_per_deg;
  constexpr double few = 0.35;  // deviations of the edges: trails of bubbles are among them, and widen these
  Bound bound;
  for (int step = 0; step < steps; ++step) {
    const Normal n = normal_of(straightened(smooth, pose), pose.column, bound);
    constexpr double more_than_noise = 1.5;
    if (n.count == 0 || !(n.cc > more_than_noise * noise2 * n.noise_cc)) return std::nullopt;
    const double determinant = n.cc * n.tt - n.ct * n.ct;
    if (!(determinant > 0)) return std::nullopt;
    const double column = std::clamp((n.ct * n.tr - n.tt * n.cr) / determinant, -5.0, 5.0);
    const double tilt = std::clamp((n.ct * n.cr - n.cc * n.tr) / determinant, -0.05, 0.05);
    pose.column += column;
    pose.tilt_rad += tilt;
    if (std::abs(pose.tilt_rad) > farthest_rad) return std::nullopt;
    bound.residual = std::min(bound.residual, few * stats::robust_sigma(edge_differences(n.lines)) + 1e-30);
    // The slopes of the noise are no knowledge of the axis, and blurred pixels do not err one by one.
    const double cc = n.cc - noise2 * n.noise_cc;
    const double tt = std::max(n.tt - noise2 * n.noise_tt, 1e-6 * n.tt);
    const double left = std::max(cc * tt - n.ct * n.ct, 1e-6 * cc * tt);
    const double variance = 4 * std::numbers::pi * axis_blur_px * axis_blur_px * n.rr / static_cast<double>(n.count);
    const Pull ranges_say = disagreement(n, cc, tt, left);
    estimate.column_sigma =
        std::sqrt(std::max(variance * tt / left, std::pow(softness(n.stiff_cc, n.cc), 2) * ranges_say[0]));
    estimate.tilt_sigma_rad =
        std::sqrt(std::max(variance * cc / left, std::pow(softness(n.stiff_tt, n.tt), 2) * ranges_say[1]));
    if (std::abs(column) < 1e-3 && std::abs(tilt) < 1e-5) break;
  }
  return estimate;
}

}  // namespace

AxisEstimate find_axis(const Image& mean_view) {
  if (const auto found = axis_of(mean_view)) return *found;
  throw Error{Fault::data, "views: no rotation axis found, the mean view of " + std::to_string(mean_view.width) +
                               " x " + std::to_string(mean_view.height) +
                               " pixels has no contrast that is symmetric about a column"};
}

AxisEstimate find_axis(std::span<const CameraView> views) {
  constexpr double sharp_px = 0.01;  // of clean views
  const AxisEstimate of_mean = find_axis(mean_view(views));
  if (of_mean.column_sigma < sharp_px) return of_mean;
  auto axis = axis_of(middle_view(views));
  if (!axis) return of_mean;
  constexpr double left = 0.5;  // of what bubbles do to the mean, at most; they err alike in all ranges of the middle
  axis->column_sigma = std::hypot(axis->column_sigma, left * of_mean.column_sigma);
  axis->tilt_sigma_rad = std::hypot(axis->tilt_sigma_rad, left * of_mean.tilt_sigma_rad);
  return axis->column_sigma < of_mean.column_sigma ? *axis : of_mean;
}

}  // namespace vam::metrology

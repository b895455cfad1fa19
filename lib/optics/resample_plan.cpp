// SPDX-License-Identifier: GPL-3.0-or-later
// The equation of resampling, S_p(x_p, theta) = S_v(x_v, theta + delta) J / T, and its inverse: which input columns and
// rows make each output column [RAY21 eq 3, OST22 eq 1; physics §3].
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/constants.hpp"
#include "base/cubic.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "optics/resample.hpp"

namespace vam::optics {

namespace {

// The taps of one output column of resampling.

// Input columns: a kernel so wide has its moments unhelped, to a float's precision.
constexpr double smooth = 4096;

double kernel(Interpolation interpolation, double x) {
  return interpolation == Interpolation::linear ? std::max(0.0, 1.0 - std::abs(x)) : cubic_kernel(x);
}

// Taps around `column` of the kernel stretched to `width` >= 1 input columns. Sampled between its knots a stretched
// kernel no longer reproduces polynomials; the smallest change b(d) (p + q d + r d^2) under a positive bump b restores
// its order, that is the moments 1, 0 of the tent and 1, 0, 0 of the cubic (d = distance / width).
std::vector<double> kernel_taps(Interpolation interpolation, double column, double width, int first, int last) {
  const int order = interpolation == Interpolation::linear ? 2 : 3;
  const double half = order - 1;
  const auto bump = [&](double d) { return (1 - d / half) * (1 + d / half); };
  std::vector<double> taps;
  for (int c = first; c <= last; ++c) taps.push_back(kernel(interpolation, (c - column) / width) / width);
  if (width == 1.0 || width >= smooth) return taps;
  double system[3][4] = {{0, 0, 0, 1}, {}, {}};  // moments of the bump; what the kernel's moments lack
  for (int c = first; c <= last; ++c) {
    const double d = (c - column) / width;
    for (int i = 0; i < order; ++i) {
      for (int j = 0; j < order; ++j) system[i][j] += bump(d) * std::pow(d, i + j);
      system[i][3] -= taps[c - first] * std::pow(d, i);
    }
  }
  for (int i = 0; i < order; ++i) {  // Gauss without pivoting: a Gram matrix is positive definite
    for (int below = i + 1; below < order; ++below) {
      const double ratio = system[below][i] / system[i][i];
      for (int j = i; j < 4; ++j) system[below][j] -= ratio * system[i][j];
    }
  }
  double factor[3] = {};
  for (int i = order - 1; i >= 0; --i) {
    factor[i] = system[i][3];
    for (int j = i + 1; j < order; ++j) factor[i] -= system[i][j] * factor[j];
    factor[i] /= system[i][i];
  }
  for (int c = first; c <= last; ++c) {
    const double d = (c - column) / width;
    taps[c - first] += bump(d) * (factor[0] + d * (factor[1] + d * factor[2]));
  }
  return taps;
}

/// Adds the source of one output column: input position `column`, stretched by `width` >= 1 input columns (a coarser
/// output is an average), at input row `row` for output row 0, all times `weight`. However wide, it costs no more than
/// the input has columns, or some thousand.
void add_source(ResamplePlan& plan, Interpolation interpolation, double column, double width, double row,
                double weight) {
  ColumnSource source;
  const double half = (interpolation == Interpolation::linear ? 1.0 : 2.0) * width;
  // The moments are those of the whole kernel; without need of them it ends where the input does.
  const double beyond = width < smooth ? half : 0;
  const int first = floor_int(std::max(column - half, -1 - beyond)) + 1;
  const int last = ceil_int(std::min(column + half, plan.columns_in + beyond)) - 1;
  const std::vector<double> taps = kernel_taps(interpolation, column, width, first, last);
  source.first = std::max(first, 0);
  source.count = std::max(0, std::min(last, plan.columns_in - 1) - source.first + 1);
  source.weights = plan.weights.size();
  const double* inside = taps.data() + (source.first - first);
  for (int k = 0; k < source.count; ++k) plan.weights.push_back(static_cast<float>(weight * inside[k]));
  // Output row a wants input position row + sense * a: four taps around it, the first one row below.
  const double below = std::floor(row);
  const double part = row - below;
  for (int j = 0; j < 4; ++j) source.angle_weights[j] = static_cast<float>(kernel(interpolation, part + 1 - j));
  source.row = static_cast<int>(std::fmod(below - 1, plan.rows));
  if (source.row < 0) source.row += plan.rows;
  plan.sources.push_back(source);
}

void check_turn(const Turn& turn) {
  const double covered = turn.rows * std::abs(turn.step_rad);
  // A hundredth of a row: more than any file's rounding, less than any missing row.
  if (turn.rows < 4 || !(std::abs(covered - 2 * std::numbers::pi) < 0.01 * std::abs(turn.step_rad))) {
    throw Error{Fault::data, "sinogram: its " + std::to_string(turn.rows) + " angles cover " +
                                 format_number(covered * deg_per_rad) +
                                 " deg; resampling shifts in angle and needs at least 4 on exactly one turn"};
  }
}

ResamplePlan empty_plan(int columns_in, int columns_out, const Turn& turn, const ResampleOptions& options) {
  check_turn(turn);
  ResamplePlan plan;
  plan.columns_in = columns_in;
  plan.columns_out = columns_out;
  plan.rows = turn.rows;
  plan.keep_negative = options.keep_negative;
  return plan;
}

bool on(const Detector& detector, double column) { return column > -0.5 && column < detector.columns - 0.5; }

/// What the interfaces let through; light of which less than a hundredth passes is made a hundred times as bright.
double passed(const ChiefRay& ray, const ResampleOptions& options) {
  constexpr double faintest = 0.01;
  return options.fresnel ? std::max(ray.transmittance, faintest) : 1.0;
}

}  // namespace

MapPoint map_point(const View& view, double x_p_mm, const ResampleOptions& options) {
  MapPoint point{x_p_mm, chief_ray(view, x_p_mm), 0};
  if (!point.ray.hits) return point;
  point.weight = (options.jacobian ? point.ray.jacobian : 1.0) / passed(point.ray, options);
  return point;
}

ResamplePlan plan_to_projector(const View& view, const Detector& virtual_, const Detector& projector, const Turn& turn,
                               const ResampleOptions& options) {
  ResamplePlan plan = empty_plan(virtual_.columns, projector.columns, turn, options);
  // Stage angle of output row a; the part stands at direction * that.
  plan.rows_out = {turn.rows, turn.start_rad, turn.step_rad};
  plan.sense = options.direction;
  for (int c = 0; c < projector.columns; ++c) {
    const MapPoint point = map_point(view, projector.x_mm(c), options);
    const double column = virtual_.column(point.ray.x_v_mm);
    if (!point.ray.hits || !on(virtual_, column)) {
      plan.sources.emplace_back();
      continue;
    }
    // S_v(x_v, theta + delta): theta of row 0 in rows of the input.
    const double theta = options.direction * turn.start_rad + options.angle_offset_rad;
    const double row = (theta + point.ray.delta_rad - turn.start_rad) / turn.step_rad;
    const double width = std::max(1.0, point.ray.jacobian * projector.pixel_mm / virtual_.pixel_mm);
    add_source(plan, options.interpolation, column, width, row, point.weight);
  }
  return plan;
}

ResamplePlan plan_to_virtual(const View& view, const Detector& camera, const Detector& virtual_, const Turn& turn,
                             const ResampleOptions& options) {
  ResamplePlan plan = empty_plan(camera.columns, virtual_.columns, turn, options);
  plan.rows_out = {turn.rows, turn.start_rad, std::abs(turn.step_rad)};
  plan.sense = options.direction * (turn.step_rad < 0 ? -1 : 1);
  for (int c = 0; c < virtual_.columns; ++c) {
    const auto found = column_of(view, virtual_.x_mm(c));
    const double column = found ? camera.column(found->x_p_mm) : 0;
    if (!found || !on(camera, column)) {
      plan.sources.emplace_back();
      continue;
    }
    const ChiefRay& ray = found->ray;
    // S_c(x_c, theta - delta): the stage angle that puts the part at theta of row 0, in rows of the input.
    const double part = plan.rows_out.start_rad - ray.delta_rad - options.angle_offset_rad;
    const double row = (options.direction * part - turn.start_rad) / turn.step_rad;
    const double width = std::max(1.0, virtual_.pixel_mm / (ray.jacobian * camera.pixel_mm));
    const double weight = 1.0 / (passed(ray, options) * (options.jacobian ? ray.jacobian : 1.0));
    add_source(plan, options.interpolation, column, width, row, weight);
  }
  return plan;
}

}  // namespace vam::optics

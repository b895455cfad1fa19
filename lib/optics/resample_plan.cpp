// SPDX-License-Identifier: GPL-3.0-or-later
// The equation of resampling, S_p(x_p, theta) = S_v(x_v, theta + delta) J / T, and its inverse: which input columns and
// rows make each output column [RAY21 eq 3, OST22 eq 1; physics §3].
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/text/text.hpp"
#include "optics/private/resample_taps.hpp"
#include "optics/resample.hpp"

namespace vam::optics {

namespace {

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

// SPDX-License-Identifier: GPL-3.0-or-later
// Axes of figures: where the ticks are and what they say.
#pragma once

#include <string>
#include <vector>

#include "plot/canvas.hpp"

namespace vam::plot {

/// Label with its unit, "dose / mJ cm-3". low may be above high: the axis then runs backwards.
struct Axis {
  std::string label;
  double low = 0;
  double high = 0;
  bool logarithmic = false;
  double step = 0;     // distance of the ticks; 0: whatever is round
  bool whole = false;  // ticks are at whole numbers only
};

/// Round numbers (1, 2, 5 x 10^n) between the ends, about `wanted` of them; for a logarithmic axis the powers of ten,
/// thinned when there are many.
[[nodiscard]] std::vector<double> ticks(const Axis& axis, int wanted);

/// The number as an axis shows it: "0.5", "1200", "3e+06".
[[nodiscard]] std::string tick_label(double value);

/// A step of 1, 2 or 5 x 10^n that is nearest below or at `value` (> 0).
[[nodiscard]] double round_step(double value);

/// A rectangle of the canvas with axes at its left and lower edge; maps values to spots.
struct PlotFrame {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
  Axis x;
  Axis y;  // y.low is at the bottom

  [[nodiscard]] double spot_x(double value) const;
  [[nodiscard]] double spot_y(double value) const;
  [[nodiscard]] Spot spot(double x_value, double y_value) const { return {spot_x(x_value), spot_y(y_value)}; }
};

inline constexpr double label_size = 13;
inline constexpr double title_size = 16;

/// Border, ticks, tick labels and axis labels; with grid, faint lines at the ticks across the frame.
void draw_axes(Canvas& canvas, const PlotFrame& frame, bool grid);

/// The same for each edge alone: ticks, tick labels and the label below, or at the left.
void draw_x_axis(Canvas& canvas, const PlotFrame& frame);
void draw_y_axis(Canvas& canvas, const PlotFrame& frame);

inline constexpr double x_axis_room = 44;                  // below a frame
[[nodiscard]] double y_axis_room(const PlotFrame& frame);  // at its left

}  // namespace vam::plot

// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/axis.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "base/text/text.hpp"

namespace vam::plot {

namespace {

double position(const Axis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return std::log10(value / axis.low) / std::log10(axis.high / axis.low);
}

std::vector<double> decades(double low, double high, int wanted) {
  const int first = ceil_int(std::log10(low) - 1e-9);
  const int last = floor_int(std::log10(high) + 1e-9);
  const int stride = std::max(1, (last - first + wanted) / wanted);
  std::vector<double> values;
  for (int power = first; power <= last; power += stride) values.push_back(std::pow(10.0, power));
  return values;
}

constexpr double tick_px = 5;

}  // namespace

double round_step(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  const double leading = value / decade;
  return (leading >= 5 ? 5 : leading >= 2 ? 2 : 1) * decade;
}

std::vector<double> ticks(const Axis& axis, int wanted) {
  const double low = std::min(axis.low, axis.high);
  const double high = std::max(axis.low, axis.high);
  if (!(high > low) || wanted < 1) return {low};
  if (axis.logarithmic) return decades(low, high, wanted);
  double step = axis.step > 0 ? axis.step : round_step((high - low) / wanted);
  const auto ticks_by = [&](double by) { return std::floor(high / by + 1e-6) - std::ceil(low / by - 1e-6) + 1; };
  const double coarser = round_step(2.5 * step);
  if (axis.step == 0 && (high - low) / step > 1.6 * wanted && ticks_by(coarser) > 1) step = coarser;
  if (axis.whole) step = std::max(1.0, step);
  std::vector<double> values;
  for (double n = std::ceil(low / step - 1e-6); n * step <= high + 1e-6 * step; ++n)
    values.push_back(n == 0 ? 0 : n * step);
  return values;
}

std::string tick_label(double value) { return format_number(value, 6); }

double PlotFrame::spot_x(double value) const { return left + (right - left) * position(x, value); }
double PlotFrame::spot_y(double value) const { return bottom - (bottom - top) * position(y, value); }

namespace {

std::vector<double> x_ticks(const PlotFrame& frame) {
  return ticks(frame.x, std::max(2, static_cast<int>((frame.right - frame.left) / 90)));
}

std::vector<double> y_ticks(const PlotFrame& frame) {
  return ticks(frame.y, std::max(2, static_cast<int>((frame.bottom - frame.top) / 60)));
}

double widest_label(const PlotFrame& frame) {
  double widest = 0;
  for (const double value : y_ticks(frame)) {
    widest = std::max(widest, Canvas::text_width(tick_label(value), label_size));
  }
  return widest;
}

}  // namespace

double y_axis_room(const PlotFrame& frame) {
  const double label = frame.y.label.empty() ? 0 : label_size + 10;
  return tick_px + 4 + widest_label(frame) + label;
}

void draw_x_axis(Canvas& canvas, const PlotFrame& frame) {
  for (const double value : x_ticks(frame)) {
    const double x = frame.spot_x(value);
    canvas.line({x, frame.bottom}, {x, frame.bottom + tick_px}, paint::black);
    canvas.text({x, frame.bottom + tick_px + 5}, tick_label(value), label_size, paint::black, Align::middle,
                Align::begin);
  }
  canvas.text({0.5 * (frame.left + frame.right), frame.bottom + 28}, frame.x.label, label_size, paint::black,
              Align::middle, Align::begin);
}

void draw_y_axis(Canvas& canvas, const PlotFrame& frame) {
  for (const double value : y_ticks(frame)) {
    const double y = frame.spot_y(value);
    canvas.line({frame.left - tick_px, y}, {frame.left, y}, paint::black);
    canvas.text({frame.left - tick_px - 4, y}, tick_label(value), label_size, paint::black, Align::end, Align::middle);
  }
  canvas.text({frame.left - tick_px - 4 - widest_label(frame) - 10, 0.5 * (frame.top + frame.bottom)}, frame.y.label,
              label_size, paint::black, Align::middle, Align::end, true);
}

void draw_axes(Canvas& canvas, const PlotFrame& frame, bool grid) {
  if (grid) {
    for (const double value : x_ticks(frame)) {
      canvas.line({frame.spot_x(value), frame.top}, {frame.spot_x(value), frame.bottom}, paint::light_grey);
    }
    for (const double value : y_ticks(frame)) {
      canvas.line({frame.left, frame.spot_y(value)}, {frame.right, frame.spot_y(value)}, paint::light_grey);
    }
  }
  draw_x_axis(canvas, frame);
  draw_y_axis(canvas, frame);
  canvas.outline({frame.left, frame.top}, {frame.right, frame.bottom}, paint::black);
}

}  // namespace vam::plot

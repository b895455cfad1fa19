#include "plot/axis.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "base/text.hpp"

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
  if (axis.step == 0 && (high - low) / step > 1.6 * wanted) step = round_step(2.5 * step);
  std::vector<double> values;
  for (double n = std::ceil(low / step - 1e-6); n * step <= high + 1e-6 * step; ++n)
    values.push_back(n == 0 ? 0 : n * step);
  return values;
}

std::string tick_label(double value) { return format_number(value, 6); }

double PlotFrame::spot_x(double value) const { return left + (right - left) * position(x, value); }
double PlotFrame::spot_y(double value) const { return bottom - (bottom - top) * position(y, value); }

void draw_axes(Canvas& canvas, const PlotFrame& frame, bool grid) {
  const int across = std::max(2, static_cast<int>((frame.right - frame.left) / 90));
  const int up = std::max(2, static_cast<int>((frame.bottom - frame.top) / 60));
  double widest = 0;
  for (const double value : ticks(frame.x, across)) {
    const double x = frame.spot_x(value);
    if (grid) canvas.line({x, frame.top}, {x, frame.bottom}, paint::light_grey);
    canvas.line({x, frame.bottom}, {x, frame.bottom + tick_px}, paint::black);
    canvas.text({x, frame.bottom + tick_px + 4}, tick_label(value), label_size, paint::black, Align::middle,
                Align::begin);
  }
  for (const double value : ticks(frame.y, up)) {
    const double y = frame.spot_y(value);
    if (grid) canvas.line({frame.left, y}, {frame.right, y}, paint::light_grey);
    canvas.line({frame.left - tick_px, y}, {frame.left, y}, paint::black);
    canvas.text({frame.left - tick_px - 2, y}, tick_label(value), label_size, paint::black, Align::end, Align::middle);
    widest = std::max(widest, Canvas::text_width(tick_label(value), label_size));
  }
  canvas.outline({frame.left, frame.top}, {frame.right, frame.bottom}, paint::black);
  canvas.text({0.5 * (frame.left + frame.right), frame.bottom + 30}, frame.x.label, label_size, paint::black,
              Align::middle, Align::begin);
  canvas.text({frame.left - tick_px - widest - 12, 0.5 * (frame.top + frame.bottom)}, frame.y.label, label_size,
              paint::black, Align::middle, Align::end, true);
}

}  // namespace vam::plot

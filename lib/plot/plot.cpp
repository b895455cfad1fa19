#include "plot/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vam::plot {

namespace {

bool shown(const Axis& axis, double value) { return std::isfinite(value) && (!axis.logarithmic || value > 0); }

// The ends that the data ask for, where the caller gave none.
Axis fitted(Axis axis, const std::vector<Series>& series, std::vector<double> Series::*values) {
  if (axis.low != axis.high) return axis;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  bool bars = false;
  for (const auto& one : series) {
    bars = bars || (one.style == SeriesStyle::bars);
    for (const double value : one.*values) {
      if (!shown(axis, value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (!(low <= high)) low = axis.logarithmic ? 1 : 0, high = low;
  const bool heights = values == &Series::y && bars;
  if (axis.logarithmic) {
    axis.low = low / 1.3;
    axis.high = high * 1.3;
  } else {
    const double margin = high > low ? 0.05 * (high - low) : 0.5;
    axis.low = heights ? 0 : values == &Series::x ? low : low - margin;
    axis.high = heights || values == &Series::y ? high + margin : high;
    if (!(axis.high > axis.low)) axis.high = axis.low + 1;
  }
  return axis;
}

// Draws nothing outside the frame: the curve is cut where it leaves it.
void draw_line(Canvas& canvas, const PlotFrame& frame, const Series& series) {
  std::vector<Spot> spots;
  const auto flush = [&] {
    if (spots.size() > 1) canvas.polyline(spots, series.colour, 2);
    if (spots.size() == 1) canvas.disc(spots[0], 2, series.colour);
    spots.clear();
  };
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!shown(frame.x, series.x[i]) || !shown(frame.y, series.y[i])) {
      flush();
      continue;
    }
    const Spot spot = frame.spot(series.x[i], series.y[i]);
    if (spot.x < frame.left - 1 || spot.x > frame.right + 1) continue;
    spots.push_back({spot.x, std::clamp(spot.y, frame.top, frame.bottom)});
  }
  flush();
}

void draw_points(Canvas& canvas, const PlotFrame& frame, const Series& series) {
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!shown(frame.x, series.x[i]) || !shown(frame.y, series.y[i])) continue;
    const Spot spot = frame.spot(series.x[i], series.y[i]);
    const bool inside = spot.x >= frame.left && spot.x <= frame.right && spot.y >= frame.top && spot.y <= frame.bottom;
    if (inside) canvas.disc(spot, 3, series.colour);
  }
}

// The bars' filling, or the line along their tops: all fillings come before all lines.
void draw_bars(Canvas& canvas, const PlotFrame& frame, const Series& series, bool filling) {
  std::vector<Spot> top;
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    const bool visible = shown(frame.y, series.y[i]);
    const double y = visible ? std::clamp(frame.spot_y(series.y[i]), frame.top, frame.bottom) : frame.bottom;
    const double left = std::clamp(frame.spot_x(series.x[i]), frame.left, frame.right);
    const double right = std::clamp(frame.spot_x(series.x[i + 1]), frame.left, frame.right);
    if (filling) canvas.fill({left, y}, {right, frame.bottom}, series.colour, 0.35);
    top.push_back({left, y});
    top.push_back({right, y});
  }
  if (!filling) canvas.polyline(top, series.colour, 1.5);
}

// Spots of data and markers in the upper part of one half of the frame: where the legend would be in their way.
int crowd(const PlotFrame& frame, const Plot& plot, bool right_half) {
  const auto in_the_way = [&](double x, double y) {
    const bool half = right_half ? x > 0.5 * (frame.left + frame.right) : x < 0.5 * (frame.left + frame.right);
    return half && y < frame.top + 0.3 * (frame.bottom - frame.top);
  };
  int spots = 0;
  for (const auto& one : plot.series) {
    for (std::size_t i = 0; i < one.y.size(); ++i) {
      if (!shown(frame.x, one.x[i]) || !shown(frame.y, one.y[i])) continue;
      spots += in_the_way(frame.spot_x(one.x[i]), frame.spot_y(one.y[i])) ? 1 : 0;
    }
  }
  for (const auto& marker : plot.markers) spots += in_the_way(frame.spot_x(marker.x), frame.top) ? 10 : 0;
  return spots;
}

void draw_legend(Canvas& canvas, const PlotFrame& frame, const Plot& plot) {
  const auto& series = plot.series;
  double widest = 0;
  for (const auto& one : series) widest = std::max(widest, Canvas::text_width(one.name, label_size));
  if (widest == 0) return;
  constexpr double row = 24;
  const bool to_the_left = crowd(frame, plot, true) > crowd(frame, plot, false);
  const double left = to_the_left ? frame.left + 18 : frame.right - widest - 60;
  double y = frame.top + 20;
  const auto named = std::count_if(series.begin(), series.end(), [](const Series& one) { return !one.name.empty(); });
  canvas.fill({left - 8, y - 14}, {left + widest + 44, y + row * static_cast<double>(named) - 10}, paint::white, 0.75);
  for (const auto& one : series) {
    if (one.name.empty()) continue;
    if (one.style == SeriesStyle::bars) {
      canvas.fill({left, y - 7}, {left + 28, y + 7}, one.colour, 0.35);
      canvas.outline({left, y - 7}, {left + 28, y + 7}, one.colour);
    } else if (one.style == SeriesStyle::points) {
      canvas.disc({left + 14, y}, 4, one.colour);
    } else {
      canvas.line({left, y}, {left + 28, y}, one.colour, 2);
    }
    canvas.text({left + 36, y}, one.name, label_size);
    y += row;
  }
}

// All lines come before all words, so that no line runs through a word.
void draw_markers(Canvas& canvas, const PlotFrame& frame, const std::vector<Marker>& markers) {
  for (const auto& marker : markers) {
    const double x = frame.spot_x(marker.x);
    if (x < frame.left || x > frame.right) continue;
    canvas.dashed({x, frame.top}, {x, frame.bottom}, marker.colour, 1.5);
  }
  double y = frame.top + 20;
  for (const auto& marker : markers) {
    const double x = frame.spot_x(marker.x);
    if (x < frame.left || x > frame.right) continue;
    const double width = Canvas::text_width(marker.words, label_size);
    const bool to_the_left = x + width + 12 > frame.left + 0.6 * (frame.right - frame.left);
    const double left = to_the_left ? x - 8 - width : x + 8;
    canvas.fill({left - 3, y - 10}, {left + width + 3, y + 10}, paint::white, 0.85);
    canvas.text({left, y}, marker.words, label_size, marker.colour);
    y += 22;
  }
}

}  // namespace

RgbImage draw(const Plot& plot) {
  Canvas canvas(plot.width, plot.height);
  PlotFrame frame{86,
                  plot.title.empty() ? 24.0 : 52.0,
                  plot.width - 28.0,
                  plot.height - 62.0,
                  fitted(plot.x, plot.series, &Series::x),
                  fitted(plot.y, plot.series, &Series::y)};
  draw_axes(canvas, frame, true);
  for (const auto& series : plot.series) {
    if (series.style == SeriesStyle::bars) draw_bars(canvas, frame, series, true);
  }
  for (const auto& series : plot.series) {
    if (series.style == SeriesStyle::line) draw_line(canvas, frame, series);
    if (series.style == SeriesStyle::points) draw_points(canvas, frame, series);
    if (series.style == SeriesStyle::bars) draw_bars(canvas, frame, series, false);
  }
  draw_markers(canvas, frame, plot.markers);
  draw_legend(canvas, frame, plot);
  canvas.text({0.5 * (frame.left + frame.right), 26}, plot.title, title_size, paint::black, Align::middle);
  return canvas.image();
}

HistogramBuilder::HistogramBuilder(double low, double high, int bins)
    : low_(low), high_(high > low ? high : low + 1), bins_(static_cast<std::size_t>(bins), 0) {}

void HistogramBuilder::add(double value) {
  const double place = (value - low_) / (high_ - low_) * static_cast<double>(bins_.size());
  const auto bin = std::clamp(place, 0.0, static_cast<double>(bins_.size()) - 1);
  ++bins_[static_cast<std::size_t>(bin)];
  ++count_;
}

Histogram HistogramBuilder::done() const {
  Histogram histogram;
  const auto bins = static_cast<double>(bins_.size());
  for (std::size_t i = 0; i <= bins_.size(); ++i) {
    histogram.edges.push_back(low_ + (high_ - low_) * static_cast<double>(i) / bins);
  }
  for (const long n : bins_)
    histogram.percent.push_back(count_ > 0 ? 100.0 * static_cast<double>(n) / static_cast<double>(count_) : 0);
  return histogram;
}

}  // namespace vam::plot

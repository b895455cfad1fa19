// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plot/legend.hpp"

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
  if (filling && !series.x.empty())
    top.push_back({std::clamp(frame.spot_x(series.x[0]), frame.left, frame.right), frame.bottom});
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    const bool visible = shown(frame.y, series.y[i]);
    const double y = visible ? std::clamp(frame.spot_y(series.y[i]), frame.top, frame.bottom) : frame.bottom;
    const double left = std::clamp(frame.spot_x(series.x[i]), frame.left, frame.right);
    const double right = std::clamp(frame.spot_x(series.x[i + 1]), frame.left, frame.right);
    top.push_back({left, y});
    top.push_back({right, y});
  }
  if (!filling) return canvas.polyline(top, series.colour, 1.5);
  if (!top.empty()) top.push_back({top.back().x, frame.bottom});
  canvas.area(top, series.colour, 0.35);
}

Mark mark_of(SeriesStyle style) {
  return style == SeriesStyle::bars ? Mark::bar : style == SeriesStyle::points ? Mark::dot : Mark::line;
}

std::vector<LegendEntry> legend_of(const Plot& plot, const PlotFrame& frame) {
  std::vector<LegendEntry> entries;
  for (const auto& one : plot.series) {
    if (!one.name.empty()) entries.push_back({mark_of(one.style), one.colour, one.name});
  }
  for (const auto& marker : plot.markers) {
    const double x = frame.spot_x(marker.x);
    if (x >= frame.left && x <= frame.right) entries.push_back({Mark::dashed, marker.colour, marker.words});
  }
  for (const std::string& note : plot.notes) entries.push_back({Mark::none, paint::black, note});
  return entries;
}

void draw_markers(Canvas& canvas, const PlotFrame& frame, const std::vector<Marker>& markers) {
  for (const auto& marker : markers) {
    const double x = frame.spot_x(marker.x);
    if (x < frame.left || x > frame.right) continue;
    canvas.dashed({x, frame.top}, {x, frame.bottom}, marker.colour, 1.5);
  }
}

constexpr double right_margin = 28;
constexpr double top_margin = 24;
constexpr double plot_title_room = 24;

}  // namespace

PlotFrame frame_of(const Plot& plot) {
  PlotFrame frame{0,
                  top_margin + (plot.title.empty() ? 0 : plot_title_room),
                  plot.width - right_margin,
                  plot.height - x_axis_room - 12,
                  fitted(plot.x, plot.series, &Series::x),
                  fitted(plot.y, plot.series, &Series::y)};
  frame.left = y_axis_room(frame) + 12;
  frame.top += legend_height(legend_of(plot, frame), frame.right - frame.left);
  return frame;
}

Canvas draw(const Plot& plot) {
  Canvas canvas(plot.width, plot.height);
  const PlotFrame frame = frame_of(plot);
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
  const double top = plot.title.empty() ? 0.5 * top_margin : top_margin + 16;
  draw_legend(canvas, legend_of(plot, frame), {frame.left, top}, frame.right - frame.left);
  canvas.text({0.5 * (frame.left + frame.right), 24}, plot.title, title_size, paint::black, Align::middle);
  return canvas;
}

HistogramBuilder::HistogramBuilder(double low, double high, int bins)
    : low_(low), high_(high > low ? high : low + 1), bins_(bins, 0) {}

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

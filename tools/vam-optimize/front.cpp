// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/front.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "base/text/text.hpp"
#include "io/stream/stream.hpp"
#include "optimize/run/quantise.hpp"
#include "plot/plot.hpp"
#include "plot/save.hpp"
#include "vam-optimize/exposure.hpp"
#include "vam-optimize/sink.hpp"

namespace vam::optimize_tool {

optimize::Show make_show(const model::Printer& printer, const Options& options) {
  const resin::GreyLevels levels = grey_levels(printer, options.bits.value_or(printer.projector.bits));
  return [levels, full_scale = options.full_scale, dithered = options.dither](std::vector<Image> frames) {
    optimize::quantise(frames, levels, full_scale.value_or(optimize::largest(frames)), dithered);
    return frames;
  };
}

namespace {

using optimize::FrontPoint;
using Plans = std::vector<std::optional<score::ExposurePlan>>;  // of each limit; none where the resin is not known

Plans plans_of(const std::vector<FrontPoint>& front, const model::Printer& printer, const model::StackInfo& info,
               const Options& options) {
  Plans plans;
  for (const FrontPoint& point : front) plans.push_back(plan_of(point.metrics, point.peak, printer, info, options));
  return plans;
}

std::string front_csv(const std::vector<FrontPoint>& front, const Plans& plans) {
  std::ostringstream csv;
  csv << "max_intensity,duration_s,turns,latitude,pw,ver,iou,peak_intensity,efficiency,latitude_tolerances\n";
  for (std::size_t i = 0; i < front.size(); ++i) {
    const FrontPoint& point = front[i];
    csv << format_number(point.max_intensity) << ",";
    if (plans[i]) csv << format_number(plans[i]->seconds) << "," << plans[i]->turns;
    if (!plans[i]) csv << ",";
    const model::DoseMetrics& m = point.metrics;
    for (const double figure : {m.latitude, m.pw, m.ver, m.iou, point.peak, point.efficiency})
      csv << "," << format_number(figure);
    csv << "," << (point.latitude_tolerances ? format_number(*point.latitude_tolerances) : "") << "\n";
  }
  return csv.str();
}

/// A line with its points.
void add_curve(plot::Plot& plot, const std::string& name, const std::vector<double>& x, const std::vector<double>& y,
               Rgb colour) {
  plot.series.push_back({name, x, y, colour, plot::SeriesStyle::line});
  plot.series.push_back({"", x, y, colour, plot::SeriesStyle::points});
}

/// Latitude above, IoU below, over the same axis.
plot::Canvas front_figure(const std::vector<FrontPoint>& front, const Plans& plans) {
  const bool timed = std::all_of(plans.begin(), plans.end(), [](const auto& plan) { return plan.has_value(); });
  std::vector<double> x, latitude, iou, latitude_tolerances;
  for (std::size_t i = 0; i < front.size(); ++i) {
    x.push_back(timed ? plans[i]->seconds : front[i].efficiency);
    latitude.push_back(front[i].metrics.latitude);
    iou.push_back(front[i].metrics.iou);
    if (front[i].latitude_tolerances) latitude_tolerances.push_back(*front[i].latitude_tolerances);
  }
  plot::Plot windows;
  windows.title = "Latitude of dose against print duration, in the projector's grey levels";
  windows.x.label = timed ? "duration at full grey (s)" : "mean / peak intensity (higher: shorter)";
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  windows.x.low = *least - 0.05 * std::abs(*most);
  windows.x.high = 1.05 * *most;
  windows.y.label = "latitude / threshold dose";
  windows.height = 460;
  plot::Plot overlaps;
  overlaps.x = windows.x;
  overlaps.y = {"IoU", std::min(0.99, *std::min_element(iou.begin(), iou.end()) - 0.01), 1.001};
  overlaps.height = 300;
  add_curve(windows, latitude_tolerances.empty() ? "" : "nominal printer", x, latitude, plot::paint::blue);
  if (!latitude_tolerances.empty())
    add_curve(windows, "with all tolerances", x, latitude_tolerances, plot::paint::vermilion);
  add_curve(overlaps, "", x, iou, plot::paint::blue);
  plot::Canvas canvas(windows.width, windows.height + overlaps.height);
  canvas.place(plot::draw(windows), {0, 0});
  canvas.place(plot::draw(overlaps), {0, static_cast<double>(windows.height)});
  return canvas;
}

}  // namespace

void write_front(const std::string& path, const std::vector<FrontPoint>& front, const model::Printer& printer,
                 const model::StackInfo& info, const Options& options) {
  const Plans plans = plans_of(front, printer, info, options);
  if (!plot::is_figure(path)) return io::write_text(path, front_csv(front, plans));
  plot::save(path, front_figure(front, plans));
}

}  // namespace vam::optimize_tool

// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/curves.hpp"

#include <array>

#include "base/text/text.hpp"

namespace vam::plot {

Plot convergence(const std::vector<Trace>& traces) {
  constexpr std::array<std::array<Rgb, 2>, 3> colours{
      {{paint::blue, paint::vermilion}, {paint::green, paint::orange}, {paint::black, paint::grey}}};
  Plot curves;
  curves.x.label = "iteration";
  curves.x.whole = true;
  curves.y.label = "VER, process window / largest dose";
  for (std::size_t n = 0; n < traces.size(); ++n) {
    const Trace& trace = traces[n];
    const std::string name = trace.name.empty() ? "" : trace.name + ": ";
    const auto& [window, errors] = colours[n % colours.size()];
    curves.series.push_back({name + "process window", trace.iteration, trace.window, window, SeriesStyle::line});
    curves.series.push_back({name + "VER", trace.iteration, trace.ver, errors, SeriesStyle::line});
  }
  return curves;
}

Plot deviation_histogram(const Histogram& histogram, double rms_mm) {
  Plot plot;
  plot.title = "Deviation of the print, RMS " + format_number(rms_mm, 3) + " mm";
  plot.x = {"distance to the design (mm), positive outside", histogram.edges.front(), histogram.edges.back()};
  plot.y.label = "share of the area (%)";
  plot.series.push_back({"", histogram.edges, histogram.percent, paint::blue, SeriesStyle::bars});
  plot.markers.push_back({0, "design", paint::grey});
  plot.notes.push_back("first bin with all below: " + format_number(histogram.percent.front(), 2) + " %");
  plot.notes.push_back("last bin with all above: " + format_number(histogram.percent.back(), 2) + " %");
  return plot;
}

}  // namespace vam::plot

// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/deviation_histogram.hpp"

#include "base/text/text.hpp"

namespace vam::plot {

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

// SPDX-License-Identifier: GPL-3.0-or-later
// Figures with curves and histograms.
#pragma once

#include <string>
#include <vector>

#include "plot/axis.hpp"

namespace vam::plot {

enum class SeriesStyle {
  line,    // y over x, joined
  points,  // a dot each
  bars,    // x has one more entry than y: the edges of the bins; filled half-transparently, with the top as a line
};

struct Series {
  std::string name;  // in the legend; none when empty
  std::vector<double> x;
  std::vector<double> y;
  Rgb colour = paint::blue;
  SeriesStyle style = SeriesStyle::line;
};

/// A dashed vertical line, in the legend.
struct Marker {
  double x = 0;
  std::string words;
  Rgb colour = paint::grey;
};

/// An axis whose ends are equal takes them from the data: y of bars from 0, otherwise with a margin of 5 %. On a
/// logarithmic axis what is not above 0 is left out.
struct Plot {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Series> series;
  std::vector<Marker> markers;
  std::vector<std::string> notes = {};  // more words of the legend
  int width = 900;
  int height = 600;
};

[[nodiscard]] Canvas draw(const Plot& plot);
/// Where the curves are: axes with their ends, and the place of the frame on the canvas.
[[nodiscard]] PlotFrame frame_of(const Plot& plot);

/// Equal bins over [low, high]: edges (one more than bins) and the share of the values in each, in percent of their
/// number. Values outside count into the first or last bin.
struct Histogram {
  std::vector<double> edges;
  std::vector<double> percent;
};
class HistogramBuilder {
 public:
  HistogramBuilder(double low, double high, int bins);
  void add(double value);
  [[nodiscard]] long count() const { return count_; }
  [[nodiscard]] Histogram done() const;

 private:
  double low_;
  double high_;
  std::vector<long> bins_;
  long count_ = 0;
};

}  // namespace vam::plot

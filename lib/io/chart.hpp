// Small scientific figures: pictures and curves with axes, side by side on one canvas.
#pragma once

#include <span>
#include <string>

#include "base/pixels.hpp"

namespace vam::io {

struct ChartAxis {
  std::string label;  // with its unit
  double low = 0;     // at the left or bottom end; low > high turns the axis round
  double high = 1;
  bool logarithmic = false;  // base 10; low and high are then above 0
};

/// A rectangle of the canvas, in pixels from the top left.
struct ChartBox {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

/// A frame with labelled axes in a box of the canvas, into which data are drawn. What lies outside the axes is cut off.
class Chart {
 public:
  /// The box is what the data fill; leave 60 pixels to its left, 45 below and 25 above for the labels.
  Chart(RgbImage& canvas, const ChartBox& box, ChartAxis x, ChartAxis y, const std::string& title);

  void line(std::span<const double> x, std::span<const double> y, Rgb colour, int width = 2);
  void dots(std::span<const double> x, std::span<const double> y, Rgb colour, int radius = 4);
  /// Between two curves over the same x.
  void band(std::span<const double> x, std::span<const double> low, std::span<const double> high, Rgb colour);
  /// Pixels of a picture over the whole frame, enlarged or reduced without smoothing.
  void picture(const RgbImage& image);
  /// A line of the legend, from the top right corner down.
  void legend(const std::string& text, Rgb colour);

 private:
  struct Point {
    double x;
    double y;
  };
  [[nodiscard]] Point place(double x, double y) const;
  void frame();
  RgbImage& canvas_;
  ChartBox box_;
  ChartAxis x_;
  ChartAxis y_;
  int legends_ = 0;
};

/// Text with its left end and baseline at (x, y).
void draw_text(RgbImage& canvas, int x, int y, const std::string& text, Rgb colour = {0, 0, 0}, double size = 0.42);

}  // namespace vam::io

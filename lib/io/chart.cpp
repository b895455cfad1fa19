#include "io/chart.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "base/log.hpp"

namespace vam::io {

namespace {

constexpr Rgb ink{40, 40, 40};
constexpr Rgb grid_ink{225, 225, 225};
constexpr double label_size = 0.42;
constexpr int subpixel_bits = 4;  // coordinates in 1/16 pixel

cv::Mat view(RgbImage& canvas) { return {canvas.height, canvas.width, CV_8UC3, canvas.values.data()}; }
cv::Scalar colour_of(Rgb c) {
  return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

int text_width(const std::string& text, double size) {
  int baseline = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &baseline).width;
}

// Round numbers, about five of them; powers of ten on a logarithmic axis (with 2 and 5 where there are few).
std::vector<double> ticks_of(const ChartAxis& axis) {
  const double low = std::min(axis.low, axis.high);
  const double high = std::max(axis.low, axis.high);
  std::vector<double> ticks;
  if (axis.logarithmic) {
    const bool few = std::log10(high / low) < 2;
    for (double decade = std::pow(10, std::floor(std::log10(low))); decade <= high; decade *= 10) {
      for (const double step : {1.0, 2.0, 5.0}) {
        const double tick = decade * step;
        if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9) && (few || step == 1)) ticks.push_back(tick);
      }
    }
    return ticks;
  }
  const double rough = (high - low) / 5;
  double step = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {2.0, 2.5, 2.0}) {
    if (step < rough * 0.7) step *= factor;
  }
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    ticks.push_back(k * step + 0.0);  // + 0.0: no -0
  return ticks;
}

double fraction(const ChartAxis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return std::log(std::max(value, 1e-300) / axis.low) / std::log(axis.high / axis.low);
}

}  // namespace

void draw_text(RgbImage& canvas, int x, int y, const std::string& text, Rgb colour, double size) {
  cv::Mat mat = view(canvas);
  cv::putText(mat, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, size, colour_of(colour), 1, cv::LINE_AA);
}

Chart::Chart(RgbImage& canvas, const ChartBox& box, ChartAxis x, ChartAxis y, const std::string& title)
    : canvas_(canvas), box_(box), x_(std::move(x)), y_(std::move(y)) {
  draw_text(canvas_, box_.left, box_.top - 8, title, ink, 0.45);
  frame();
}

Chart::Point Chart::place(double x, double y) const {
  return {box_.left + fraction(x_, x) * box_.width, box_.top + (1 - fraction(y_, y)) * box_.height};
}

void Chart::frame() {
  cv::Mat mat = view(canvas_);
  const int bottom = box_.top + box_.height;
  for (const double tick : ticks_of(x_)) {
    const int at = static_cast<int>(std::lround(place(tick, y_.low).x));
    cv::line(mat, {at, box_.top}, {at, bottom}, colour_of(grid_ink));
    const std::string text = format_number(tick, 4);
    draw_text(canvas_, at - text_width(text, label_size) / 2, bottom + 15, text, ink, label_size);
  }
  for (const double tick : ticks_of(y_)) {
    const int at = static_cast<int>(std::lround(place(x_.low, tick).y));
    cv::line(mat, {box_.left, at}, {box_.left + box_.width, at}, colour_of(grid_ink));
    const std::string text = format_number(tick, 4);
    draw_text(canvas_, box_.left - 5 - text_width(text, label_size), at + 4, text, ink, label_size);
  }
  cv::rectangle(mat, {box_.left, box_.top}, {box_.left + box_.width, bottom}, colour_of(ink));
  draw_text(canvas_, box_.left + (box_.width - text_width(x_.label, label_size)) / 2, bottom + 34, x_.label, ink,
            label_size);
  // The label of y stands upright to the left of the numbers.
  const int length = text_width(y_.label, label_size);
  if (length == 0) return;
  RgbImage upright(length + 4, 16, {255, 255, 255});
  draw_text(upright, 2, 12, y_.label, ink, label_size);
  const int left = std::max(0, box_.left - 58);
  const int top = box_.top + (box_.height - upright.width) / 2;
  for (int y = 0; y < upright.height; ++y) {
    for (int x = 0; x < upright.width; ++x) {
      const int row = top + upright.width - 1 - x;
      if (row >= 0 && row < canvas_.height && left + y < canvas_.width) canvas_(left + y, row) = upright(x, y);
    }
  }
}

void Chart::line(std::span<const double> x, std::span<const double> y, Rgb colour, int width) {
  // Drawn on the frame's own part of the canvas, which cuts off what lies outside.
  cv::Mat mat = view(canvas_)(cv::Rect(box_.left, box_.top, box_.width + 1, box_.height + 1));
  const auto pixel = [&](std::size_t i) {
    const Point p = place(x[i], y[i]);
    const auto scaled = [](double value) {
      return static_cast<int>(std::lround(std::clamp(value, -1e5, 1e5) * (1 << subpixel_bits)));
    };
    return cv::Point(scaled(p.x - box_.left), scaled(p.y - box_.top));
  };
  for (std::size_t i = 1; i < x.size(); ++i) {
    if (!std::isfinite(y[i - 1]) || !std::isfinite(y[i])) continue;
    cv::line(mat, pixel(i - 1), pixel(i), colour_of(colour), width, cv::LINE_AA, subpixel_bits);
  }
}

void Chart::dots(std::span<const double> x, std::span<const double> y, Rgb colour, int radius) {
  cv::Mat mat = view(canvas_);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Point p = place(x[i], y[i]);
    if (!std::isfinite(y[i]) || p.x < box_.left || p.x > box_.left + box_.width || p.y < box_.top ||
        p.y > box_.top + box_.height) {
      continue;
    }
    cv::circle(mat, {static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y))}, radius, colour_of(colour),
               cv::FILLED, cv::LINE_AA);
  }
}

void Chart::band(std::span<const double> x, std::span<const double> low, std::span<const double> high, Rgb colour) {
  cv::Mat mat = view(canvas_)(cv::Rect(box_.left, box_.top, box_.width + 1, box_.height + 1));
  std::vector<cv::Point> outline;
  const auto add = [&](double at, double value) {
    const Point p = place(at, value);
    outline.emplace_back(static_cast<int>(std::lround(p.x)) - box_.left,
                         static_cast<int>(std::lround(std::clamp(p.y, -1e5, 1e5))) - box_.top);
  };
  for (std::size_t i = 0; i < x.size(); ++i) add(x[i], high[i]);
  for (std::size_t i = x.size(); i-- > 0;) add(x[i], low[i]);
  if (!outline.empty()) cv::fillPoly(mat, std::vector<std::vector<cv::Point>>{outline}, colour_of(colour));
}

void Chart::picture(const RgbImage& image) {
  for (int y = 0; y < box_.height; ++y) {
    const int from_y = std::min(image.height - 1, y * image.height / box_.height);
    for (int x = 0; x < box_.width; ++x) {
      canvas_(box_.left + x, box_.top + y) = image(std::min(image.width - 1, x * image.width / box_.width), from_y);
    }
  }
  cv::Mat mat = view(canvas_);
  cv::rectangle(mat, {box_.left, box_.top}, {box_.left + box_.width, box_.top + box_.height}, colour_of(ink));
}

void Chart::legend(const std::string& text, Rgb colour) {
  const int right = box_.left + box_.width - 8;
  const int y = box_.top + 16 + 16 * legends_++;
  const int left = right - text_width(text, label_size);
  cv::Mat mat = view(canvas_);
  cv::rectangle(mat, {left - 3, y - 12}, {right + 3, y + 4}, cv::Scalar(255, 255, 255), cv::FILLED);
  draw_text(canvas_, left, y, text, colour, label_size);
}

}  // namespace vam::io

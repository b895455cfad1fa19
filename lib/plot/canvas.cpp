#include "plot/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/index.hpp"

namespace vam::plot {

namespace {

constexpr int shift = 4;        // OpenCV draws at fractions of a pixel when coordinates come in 1/16
constexpr int supersample = 4;  // its letters are thin polygons: drawn large and averaged they come out even
constexpr int font = cv::FONT_HERSHEY_SIMPLEX;
constexpr double font_height = 30;  // pixels of a line at scale 1, descenders included

cv::Scalar scalar(Rgb colour) { return {double(colour[0]), double(colour[1]), double(colour[2])}; }

cv::Point fine(Spot spot) { return {round_int(spot.x * (1 << shift)), round_int(spot.y * (1 << shift))}; }

int whole(double thickness) { return std::max(1, round_int(thickness)); }

struct Letters {
  cv::Mat mask;     // opacity 0..255
  double height;    // of the capital letters
  double baseline;  // rows from the top of the mask
};

int stroke(double size) { return std::max(1, round_int(size * supersample / 13)); }

Letters letters(const std::string& words, double size) {
  const double scale = size * supersample / font_height;
  int below = 0;
  const cv::Size box = cv::getTextSize(words, font, scale, stroke(size), &below);
  const int margin = 2 * supersample;
  const auto rounded = [](int n) { return (n + supersample - 1) / supersample * supersample; };
  cv::Mat large = cv::Mat::zeros(rounded(box.height + below + 2 * margin), rounded(box.width + 2 * margin), CV_8U);
  cv::putText(large, words, {margin, margin + box.height}, font, scale, cv::Scalar(255), stroke(size), cv::LINE_AA);
  Letters result;
  cv::resize(large, result.mask, {}, 1.0 / supersample, 1.0 / supersample, cv::INTER_AREA);
  result.height = static_cast<double>(box.height) / supersample;
  result.baseline = static_cast<double>(margin + box.height) / supersample;
  return result;
}

double aligned(Align align, double size) {
  return align == Align::begin ? 0 : align == Align::middle ? 0.5 * size : size;
}

}  // namespace

struct Canvas::State {
  cv::Mat pixels;  // RGB

  void blend(int x, int y, Rgb colour, double opacity) {
    if (x < 0 || y < 0 || x >= pixels.cols || y >= pixels.rows) return;
    auto& pixel = pixels.at<cv::Vec3b>(y, x);
    for (int c = 0; c < 3; ++c) {
      pixel[c] = static_cast<unsigned char>(std::lround((1 - opacity) * pixel[c] + opacity * colour[c]));
    }
  }
};

Canvas::Canvas(int width, int height, Rgb background) : state_(std::make_unique<State>()) {
  state_->pixels = cv::Mat(height, width, CV_8UC3, scalar(background));
}
Canvas::~Canvas() = default;

int Canvas::width() const { return state_->pixels.cols; }
int Canvas::height() const { return state_->pixels.rows; }

void Canvas::line(Spot from, Spot to, Rgb colour, double thickness) {
  cv::line(state_->pixels, fine(from), fine(to), scalar(colour), whole(thickness), cv::LINE_AA, shift);
}

void Canvas::dashed(Spot from, Spot to, Rgb colour, double thickness) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  constexpr double period = 12;
  const int dashes = ceil_int(length / period);
  for (int dash = 0; dash < dashes; ++dash) {
    const double at = dash * period;
    const auto along = [&](double d) {
      return Spot{from.x + (to.x - from.x) * d / length, from.y + (to.y - from.y) * d / length};
    };
    line(along(at), along(std::min(at + 0.5 * period, length)), colour, thickness);
  }
}

void Canvas::polyline(const std::vector<Spot>& spots, Rgb colour, double thickness) {
  std::vector<cv::Point> points;
  for (const Spot spot : spots) points.push_back(fine(spot));
  cv::polylines(state_->pixels, points, false, scalar(colour), whole(thickness), cv::LINE_AA, shift);
}

void Canvas::fill(Spot corner, Spot opposite, Rgb colour, double opacity) {
  const auto pixel = [](double x) { return round_int(x); };
  for (int y = pixel(std::min(corner.y, opposite.y)); y < pixel(std::max(corner.y, opposite.y)); ++y) {
    for (int x = pixel(std::min(corner.x, opposite.x)); x < pixel(std::max(corner.x, opposite.x)); ++x) {
      state_->blend(x, y, colour, opacity);
    }
  }
}

void Canvas::outline(Spot corner, Spot opposite, Rgb colour, double thickness) {
  polyline({corner, {opposite.x, corner.y}, opposite, {corner.x, opposite.y}, corner}, colour, thickness);
}

void Canvas::disc(Spot centre, double radius, Rgb colour) {
  cv::circle(state_->pixels, fine(centre), round_int(radius * (1 << shift)), scalar(colour), cv::FILLED, cv::LINE_AA,
             shift);
}

void Canvas::paste(const RgbImage& image, int x0, int y0) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) state_->blend(x0 + x, y0 + y, image(x, y), 1);
  }
}

void Canvas::text(Spot at, const std::string& words, double size, Rgb colour, Align horizontal, Align vertical,
                  bool upwards) {
  if (words.empty()) return;
  Letters word = letters(words, size);
  const double width = word.mask.cols;
  const double left = -aligned(horizontal, width);
  const double top = word.height - word.baseline - aligned(vertical, word.height);
  // (along, across) the text; upwards its beginning is below and its top to the left.
  const double x0 = upwards ? at.x + top : at.x + left;
  const double y0 = upwards ? at.y - left - width : at.y + top;
  if (upwards) cv::rotate(word.mask, word.mask, cv::ROTATE_90_COUNTERCLOCKWISE);
  for (int y = 0; y < word.mask.rows; ++y) {
    for (int x = 0; x < word.mask.cols; ++x) {
      const int opacity = word.mask.at<unsigned char>(y, x);
      if (opacity > 0) state_->blend(round_int(x0) + x, round_int(y0) + y, colour, opacity / 255.0);
    }
  }
}

double Canvas::text_width(const std::string& words, double size) {
  int below = 0;
  return static_cast<double>(
             cv::getTextSize(words, font, size * supersample / font_height, stroke(size), &below).width) /
         supersample;
}

RgbImage Canvas::image() const {
  RgbImage image(width(), height());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto& pixel = state_->pixels.at<cv::Vec3b>(y, x);
      image(x, y) = {pixel[0], pixel[1], pixel[2]};
    }
  }
  return image;
}

}  // namespace vam::plot

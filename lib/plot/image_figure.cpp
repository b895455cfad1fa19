#include "plot/image_figure.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/index.hpp"

namespace vam::plot {

namespace {

constexpr double bar_gap = 22;  // image to colour bar
constexpr double bar_width = 20;
constexpr int bar_ticks = 7;

struct Scale {
  double x;
  double y;
};

// Screen pixels per image pixel. Enlarged pixels are squares of whole size, so that each is as wide as the next.
Scale scale_for(const ImageFigure& figure, double room_x, double room_y) {
  const Image& image = figure.panels.front().values;
  const auto fit = [](double scale) { return scale >= 1 ? std::floor(scale) : scale; };
  double x = room_x / image.width;
  double y = room_y / image.height;
  if (figure.square_pixels) x = y = std::min(x, y);
  return {fit(x), fit(y)};
}

// Enlarged by repetition, since a voxel is a box; reduced by averaging.
RgbImage scaled(const RgbImage& image, Scale scale) {
  const cv::Mat in(image.height, image.width, CV_8UC3, const_cast<Rgb*>(image.values.data()));
  const int width = std::max(1, round_int(image.width * scale.x));
  const int height = std::max(1, round_int(image.height * scale.y));
  cv::Mat stretched;
  cv::resize(in, stretched, {width, in.rows}, 0, 0, scale.x >= 1 ? cv::INTER_NEAREST : cv::INTER_AREA);
  RgbImage out(width, height);
  cv::Mat out_view(height, width, CV_8UC3, out.values.data());
  cv::resize(stretched, out_view, {width, height}, 0, 0, scale.y >= 1 ? cv::INTER_NEAREST : cv::INTER_AREA);
  return out;
}

// White on a dark seam, so that it shows on every colour.
void draw_outline(Canvas& canvas, const Panel& panel, Spot corner, Scale scale) {
  const auto place = [&](Spot s) {
    return Spot{corner.x + (s.x + 0.5) * scale.x - 0.5, corner.y + (s.y + 0.5) * scale.y - 0.5};
  };
  for (const auto& piece : panel.outline) canvas.line(place(piece.from), place(piece.to), paint::black, 3);
  for (const auto& piece : panel.outline) canvas.line(place(piece.from), place(piece.to), paint::white, 1);
}

void draw_scale_bar(Canvas& canvas, double pixel_mm, Scale scale, Spot corner, double width, double height) {
  const double bar_mm = round_step(0.35 * width / scale.x * pixel_mm);
  const double bar = bar_mm / pixel_mm * scale.x;
  const Spot left{corner.x + 14, corner.y + height - 16};
  const std::string words = tick_label(bar_mm) + " mm";
  const double covered = std::max(bar, Canvas::text_width(words, label_size));
  canvas.fill({left.x - 8, left.y - 28}, {left.x + covered + 8, left.y + 9}, paint::black, 0.55);
  canvas.line(left, {left.x + bar, left.y}, paint::white, 3);
  canvas.text({left.x + 0.5 * bar, left.y - 8}, words, label_size, paint::white, Align::middle, Align::end);
}

void draw_colour_bar(Canvas& canvas, const ImageFigure& figure, double left, double top, double bottom) {
  const int rows = ceil_int(bottom - top);
  for (int row = 0; row < rows; ++row) {
    const double y = top + row;
    const Rgb here = colour(figure.colours, (bottom - 0.5 - y) / (bottom - top));
    canvas.fill({left, y}, {left + bar_width, y + 1}, here);
  }
  canvas.outline({left, top}, {left + bar_width, bottom}, paint::black);
  const Axis axis{"", figure.low, figure.high, false};
  const PlotFrame frame{left, top, left + bar_width, bottom, {}, axis};
  double widest = 0;
  for (const double value : ticks(axis, std::clamp(static_cast<int>((bottom - top) / 60), 2, bar_ticks))) {
    const double y = frame.spot_y(value);
    canvas.line({left + bar_width, y}, {left + bar_width + 5, y}, paint::black);
    canvas.text({left + bar_width + 8, y}, tick_label(value), label_size);
    widest = std::max(widest, Canvas::text_width(tick_label(value), label_size));
  }
  canvas.text({left + bar_width + widest + 16, 0.5 * (top + bottom)}, figure.value_label, label_size, paint::black,
              Align::middle, Align::begin, true);
}

double colour_bar_room(const ImageFigure& figure) {
  double widest = 0;
  for (const double value : ticks({"", figure.low, figure.high, false}, bar_ticks)) {
    widest = std::max(widest, Canvas::text_width(tick_label(value), label_size));
  }
  return bar_gap + bar_width + widest + 46;
}

Rgb mixed(const Rgb& under, const Rgb& over, double opacity) {
  Rgb result;
  for (std::size_t n = 0; n < result.size(); ++n) {
    result[n] = static_cast<std::uint8_t>(std::lround(under[n] + opacity * (over[n] - under[n])));
  }
  return result;
}

/// The hatching of an insert and its shadow, over the image as it stands on the canvas.
void cover(RgbImage& image, const Panel& panel) {
  constexpr double darkest = 0.75;
  constexpr int period = 8;
  constexpr int stroke = 3;
  if (panel.hatched.size() == 0) return;
  for (int y = 0; y < image.height; ++y) {
    const int row = std::min(y * panel.hatched.height / image.height, panel.hatched.height - 1);
    for (int x = 0; x < image.width; ++x) {
      const int column = std::min(x * panel.hatched.width / image.width, panel.hatched.width - 1);
      Rgb& pixel = image.values[product(y, image.width) + x];
      if (panel.hatched(column, row) >= 0.5F) {
        pixel = (x + y) % period < stroke ? paint::black : paint::light_grey;
      } else {
        pixel = mixed(pixel, paint::orange, darkest * static_cast<double>(panel.shaded(column, row)));
      }
    }
  }
}

std::string legend(const ImageFigure& figure) {
  std::string line = figure.outline_name.empty() ? "" : "line: " + figure.outline_name;
  if (figure.hatched_name.empty()) return line;
  return line + (line.empty() ? "" : "; ") + "hatched: " + figure.hatched_name;
}

void draw_panel(Canvas& canvas, const ImageFigure& figure, const Panel& panel, Spot corner, Scale scale) {
  RgbImage image = scaled(coloured(panel.values, figure.colours, figure.low, figure.high), scale);
  cover(image, panel);
  canvas.paste(image, static_cast<int>(corner.x), static_cast<int>(corner.y));
  draw_outline(canvas, panel, corner, scale);
}

RgbImage draw_single(const ImageFigure& figure) {
  const Panel& panel = figure.panels.front();
  const Scale scale = scale_for(figure, figure.size, figure.square_pixels ? figure.size : 0.75 * figure.size);
  const double width = std::round(panel.values.width * scale.x);
  const double height = std::round(panel.values.height * scale.y);
  constexpr double left = 92;
  const double top = figure.title.empty() ? 20 : 52;
  const double foot = legend(figure).empty() ? 62 : 86;
  const double title = Canvas::text_width(figure.title, title_size) + 40;
  const double total = std::max(left + width + colour_bar_room(figure), title);
  Canvas canvas(static_cast<int>(total), static_cast<int>(top + height + foot));
  draw_panel(canvas, figure, panel, {left, top}, scale);
  const PlotFrame frame{left - 0.5, top - 0.5, left + width - 0.5, top + height - 0.5, figure.x, figure.y};
  draw_axes(canvas, frame, false);
  if (figure.pixel_mm > 0) draw_scale_bar(canvas, figure.pixel_mm, scale, {left, top}, width, height);
  const double bar_height = std::max(height, 120.0);
  draw_colour_bar(canvas, figure, left + width + bar_gap, top, top + std::min(bar_height, height));
  canvas.text({0.5 * total, 26}, figure.title, title_size, paint::black, Align::middle);
  if (!legend(figure).empty()) {
    canvas.text({left + 0.5 * width, top + height + 68}, legend(figure), label_size, paint::black, Align::middle);
  }
  return canvas.image();
}

// The number of columns that makes the sheet about 4 : 3.
int sheet_columns(const ImageFigure& figure) {
  if (figure.columns > 0) return figure.columns;
  const Image& image = figure.panels.front().values;
  const double aspect = figure.square_pixels ? static_cast<double>(image.width) / image.height : 4.0 / 3;
  const auto count = static_cast<double>(figure.panels.size());
  return std::clamp(round_int(std::sqrt(count * (4.0 / 3) / aspect)), 1, static_cast<int>(count));
}

RgbImage draw_sheet(const ImageFigure& figure) {
  const int columns = sheet_columns(figure);
  const int rows = (count_of(figure.panels) + columns - 1) / columns;
  constexpr double gap = 12;
  constexpr double caption = 24;
  const double room = std::max(1.4 * figure.size / std::max(columns, rows), 96.0);
  const Scale scale = scale_for(figure, room, figure.square_pixels ? room : 0.75 * room);
  const double width = std::round(figure.panels.front().values.width * scale.x);
  const double height = std::round(figure.panels.front().values.height * scale.y);
  const double top = figure.title.empty() ? 12 : 48;
  const double foot = legend(figure).empty() ? 16 : 44;
  double cell = width;  // a caption may be wider than its image
  for (const Panel& panel : figure.panels)
    cell = std::max(cell, std::ceil(Canvas::text_width(panel.caption, label_size)));
  const double body_width = columns * (cell + gap);
  const double body_height = rows * (height + gap + caption);
  const double title = Canvas::text_width(figure.title, title_size) + 40;
  const double total = std::max(20 + body_width + colour_bar_room(figure), title);
  Canvas canvas(static_cast<int>(total), static_cast<int>(top + body_height + foot));
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const int row = static_cast<int>(i) / columns;
    const int column = static_cast<int>(i) % columns;
    const Spot corner{20 + column * (cell + gap) + std::floor(0.5 * (cell - width)),
                      top + caption + row * (height + gap + caption)};
    draw_panel(canvas, figure, figure.panels[i], corner, scale);
    canvas.outline({corner.x - 1, corner.y - 1}, {corner.x + width, corner.y + height}, paint::grey);
    canvas.text({corner.x + 0.5 * width, corner.y - 6}, figure.panels[i].caption, label_size, paint::black,
                Align::middle, Align::end);
    if (i == 0 && figure.pixel_mm > 0) draw_scale_bar(canvas, figure.pixel_mm, scale, corner, width, height);
  }
  draw_colour_bar(canvas, figure, 20 + body_width - gap + bar_gap, top + caption, top + body_height - gap);
  canvas.text({0.5 * total, 24}, figure.title, title_size, paint::black, Align::middle);
  if (!legend(figure).empty()) {
    canvas.text({20 + 0.5 * body_width, top + body_height + 20}, legend(figure), label_size, paint::black,
                Align::middle);
  }
  return canvas.image();
}

}  // namespace

RgbImage coloured(const Image& values, ColourMap map, double low, double high) {
  RgbImage image(values.width, values.height);
  const double span = high > low ? high - low : 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    image.values[i] = colour(map, (static_cast<double>(values.values[i]) - low) / span);
  }
  return image;
}

RgbImage draw(const ImageFigure& figure) {
  return figure.panels.size() == 1 ? draw_single(figure) : draw_sheet(figure);
}

}  // namespace vam::plot

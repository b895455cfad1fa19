// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/image_figure.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"

namespace vam::plot {

namespace {

constexpr double figure_margin = 14;
constexpr double title_room = 34;
constexpr double caption_room = 24;
constexpr double gap = 16;  // panel to panel, panel to colour bar
constexpr double bar_width = 18;
constexpr int bar_ticks = 7;

std::vector<double> ticks_of(const ColourScale& scale, double height) {
  return ticks({"", scale.low, scale.high, false}, std::clamp(static_cast<int>(height / 60), 2, bar_ticks));
}

/// Width that a colour bar and what is written beside it take, with the gap before it.
double bar_room(const ColourScale& scale, double height) {
  if (scale.label.empty()) return 0;
  double widest = 0;
  for (const double value : ticks_of(scale, height)) {
    widest = std::max(widest, Canvas::text_width(tick_label(value), label_size));
  }
  return gap + bar_width + 8 + widest + 12 + label_size;
}

/// Canvas pixels per image pixel. Enlarged pixels are squares of whole size, so that each is as wide as the next.
Spot magnification_for(const ImageFigure& figure, double room_x, double room_y) {
  const Image& image = figure.panels.front().values;
  const auto fit = [](double scale) { return scale >= 1 ? std::floor(scale) : scale; };
  double x = room_x / image.width;
  double y = room_y / image.height;
  if (figure.square_pixels) x = y = std::min(x, y);
  return {fit(x), fit(y)};
}

/// The number of columns that makes the sheet about 4 : 3.
int sheet_columns(const ImageFigure& figure) {
  if (figure.columns > 0) return std::min(figure.columns, count_of(figure.panels));
  const Image& image = figure.panels.front().values;
  const double aspect = figure.square_pixels ? static_cast<double>(image.width) / image.height : 4.0 / 3;
  const auto count = static_cast<double>(figure.panels.size());
  return std::clamp(round_int(std::sqrt(count * (4.0 / 3) / aspect)), 1, static_cast<int>(count));
}

std::vector<LegendEntry> legend_of(const ImageFigure& figure) {
  std::vector<LegendEntry> entries;
  if (!figure.outline_name.empty()) entries.push_back({Mark::outline, paint::white, figure.outline_name});
  if (!figure.hatched_name.empty()) entries.push_back({Mark::hatch, paint::black, figure.hatched_name});
  entries.insert(entries.end(), figure.legend.begin(), figure.legend.end());
  return entries;
}

bool is_single(const ImageFigure& figure) { return figure.panels.size() == 1; }

/// Pixels that an image may take each way: all of the figure's size, or on a sheet, which is larger, its share.
double room_of(const ImageFigure& figure, int columns, int rows) {
  constexpr double sheet_size = 1.4;  // of that of a single image
  constexpr double least_px = 96;
  if (is_single(figure)) return figure.size;
  return std::max(sheet_size * figure.size / std::max(columns, rows), least_px);
}

/// Panels in rows and columns, each with its caption above and its colour bar to the right.
struct Sheet {
  int columns = 1;
  int rows = 1;
  Spot scale{};      // canvas pixels per pixel of an image
  double width = 0;  // of an image
  double height = 0;
  double caption = 0;  // height of the captions
  double cell = 0;     // width of a panel

  [[nodiscard]] double cells_width() const { return columns * (cell + gap) - gap; }
  [[nodiscard]] double cells_height() const { return rows * (height + caption + gap) - gap; }
};

double cell_width(const ImageFigure& figure, const Sheet& sheet) {
  double cell = sheet.width;
  for (const Panel& panel : figure.panels) {
    if (!is_single(figure)) cell = std::max(cell, std::ceil(Canvas::text_width(panel.caption, label_size)));
    if (panel.scale) cell = std::max(cell, sheet.width + bar_room(*panel.scale, sheet.height));
  }
  return cell;
}

Sheet sheet_of(const ImageFigure& figure) {
  const Image& image = figure.panels.front().values;
  Sheet sheet;
  sheet.columns = sheet_columns(figure);
  sheet.rows = (count_of(figure.panels) + sheet.columns - 1) / sheet.columns;
  const double room = room_of(figure, sheet.columns, sheet.rows);
  sheet.scale = magnification_for(figure, room, figure.square_pixels ? room : 0.75 * room);
  sheet.width = std::max(1.0, std::round(image.width * sheet.scale.x));
  sheet.height = std::max(1.0, std::round(image.height * sheet.scale.y));
  sheet.caption = is_single(figure) ? 0 : caption_room;
  sheet.cell = cell_width(figure, sheet);
  return sheet;
}

/// The sheet on the canvas: title above, axes at the left of the first column and below the last row, colour bar of all
/// to the right, legend below.
struct Layout {
  Sheet sheet;
  double left = 0;    // of the first cell
  double top = 0;     // of the first row, with its captions
  double width = 0;   // of the figure
  double legend = 0;  // where it begins
  double height = 0;  // of the figure

  [[nodiscard]] Spot corner(int panel) const {
    const int column = panel % sheet.columns;
    const int row = panel / sheet.columns;
    return {left + column * (sheet.cell + gap), top + sheet.caption + row * (sheet.height + sheet.caption + gap)};
  }
  [[nodiscard]] SpotPair box(int panel) const {
    const Spot at = corner(panel);
    return {at, {at.x + sheet.width, at.y + sheet.height}};
  }
  [[nodiscard]] PlotFrame frame(const ImageFigure& figure, int panel) const {
    const auto [low, high] = box(panel);
    return {low.x, low.y, high.x, high.y, figure.x, figure.y};
  }
  /// From the first image to the last.
  [[nodiscard]] SpotPair bar() const {
    const double right = left + sheet.cells_width() + gap;
    return {{right, top + sheet.caption}, {right + bar_width, top + sheet.cells_height()}};
  }
};

Layout layout_of(const ImageFigure& figure) {
  Layout layout{sheet_of(figure)};
  const Sheet& sheet = layout.sheet;
  layout.left = std::ceil(figure_margin + y_axis_room({0, 0, sheet.width, sheet.height, figure.x, figure.y}));
  layout.top = figure_margin + (figure.title.empty() ? 0 : title_room);
  const auto [bar_top, bar_bottom] = layout.bar();
  const double images = layout.left + sheet.cells_width() + bar_room(figure.scale, bar_bottom.y - bar_top.y);
  layout.width = std::max({images + figure_margin, Canvas::text_width(figure.title, title_size) + 2 * figure_margin,
                           layout.left + std::ceil(legend_width(legend_of(figure))) + figure_margin});
  layout.legend = layout.top + sheet.cells_height() + x_axis_room + 8;
  layout.height = layout.legend + legend_height(legend_of(figure), layout.width - layout.left - figure_margin) +
                  0.5 * figure_margin;
  return layout;
}

void draw_colour_bar(Canvas& canvas, const ColourScale& scale, Spot corner, double height) {
  if (scale.label.empty()) return;
  constexpr int steps = 256;
  RgbImage colours(1, steps);
  for (int n = 0; n < steps; ++n) colours(0, n) = colour(scale.map, 1 - (n + 0.5) / steps);
  const double right = corner.x + bar_width;
  const double bottom = corner.y + height;
  canvas.paste(colours, corner, {right, bottom});
  canvas.outline(corner, {right, bottom}, paint::black);
  const PlotFrame frame{corner.x, corner.y, right, bottom, {}, {"", scale.low, scale.high, false}};
  double widest = 0;
  for (const double value : ticks_of(scale, height)) {
    const double y = frame.spot_y(value);
    canvas.line({right, y}, {right + 5, y}, paint::black);
    canvas.text({right + 8, y}, tick_label(value), label_size);
    widest = std::max(widest, Canvas::text_width(tick_label(value), label_size));
  }
  if (scale.mark && *scale.mark > scale.low && *scale.mark < scale.high) {
    const double y = frame.spot_y(*scale.mark);
    canvas.line({corner.x - 4, y}, {right, y}, paint::vermilion, 2);
  }
  canvas.text({right + 8 + widest + 10, corner.y + 0.5 * height}, scale.label, label_size, paint::black, Align::middle,
              Align::begin, true);
}

Rgb mixed(const Rgb& under, const Rgb& over, double opacity) {
  Rgb result;
  for (std::size_t n = 0; n < result.size(); ++n) {
    result[n] = static_cast<std::uint8_t>(std::lround(under[n] + opacity * (over[n] - under[n])));
  }
  return result;
}

RgbImage picture_of(const Panel& panel, const ColourScale& scale) {
  if (!panel.picture.values.empty()) return panel.picture;
  constexpr double darkest = 0.75;
  RgbImage picture = coloured(panel.values, panel.scale.value_or(scale));
  for (std::size_t i = 0; i < panel.shaded.size(); ++i) {
    picture.values[i] = mixed(picture.values[i], paint::orange, darkest * static_cast<double>(panel.shaded.values[i]));
  }
  return picture;
}

/// Boxes of the hatched pixels, as long as they follow each other in a row.
std::vector<SpotPair> hatched_boxes(const Image& hatched, const SpotPair& box) {
  std::vector<SpotPair> boxes;
  const auto spot = [&](int x, int y) {
    return Spot{box.first.x + (box.second.x - box.first.x) * x / hatched.width,
                box.first.y + (box.second.y - box.first.y) * y / hatched.height};
  };
  for (int y = 0; y < hatched.height; ++y) {
    for (int x = 0; x < hatched.width; ++x) {
      const int first = x;
      while (x < hatched.width && hatched(x, y) >= 0.5F) ++x;
      if (x > first) boxes.push_back({spot(first, y), spot(x, y + 1)});
    }
  }
  return boxes;
}

/// White on a dark seam, so that it shows on every colour.
void draw_outline(Canvas& canvas, const Panel& panel, Spot corner, Spot scale) {
  std::vector<SpotPair> pieces;
  const auto place = [&](Spot s) { return Spot{corner.x + (s.x + 0.5) * scale.x, corner.y + (s.y + 0.5) * scale.y}; };
  for (const auto& piece : panel.outline) pieces.emplace_back(place(piece.from), place(piece.to));
  canvas.lines(pieces, paint::black, 3);
  canvas.lines(pieces, paint::white, 1.2);
}

void draw_panel(Canvas& canvas, const ImageFigure& figure, const Layout& layout, int number) {
  const Panel& panel = figure.panels[static_cast<std::size_t>(number)];
  const auto [corner, opposite] = layout.box(number);
  canvas.paste(picture_of(panel, figure.scale), corner, opposite);
  if (panel.hatched.size() > 0) canvas.hatch(hatched_boxes(panel.hatched, {corner, opposite}));
  draw_outline(canvas, panel, corner, layout.sheet.scale);
  canvas.outline(corner, opposite, paint::black);
  const PlotFrame frame = layout.frame(figure, number);
  const bool lowest = number + layout.sheet.columns >= count_of(figure.panels);
  if (lowest) draw_x_axis(canvas, frame);
  if (number % layout.sheet.columns == 0) draw_y_axis(canvas, frame);
  if (!is_single(figure)) {
    canvas.text({0.5 * (corner.x + opposite.x), corner.y - 7}, panel.caption, label_size, paint::black, Align::middle,
                Align::end);
  }
  if (panel.scale) draw_colour_bar(canvas, *panel.scale, {opposite.x + gap, corner.y}, layout.sheet.height);
}

}  // namespace

RgbImage coloured(const Image& values, const ColourScale& scale) {
  RgbImage image(values.width, values.height);
  const double span = scale.high > scale.low ? scale.high - scale.low : 1;
  for (std::size_t i = 0; i < values.size(); ++i) {
    image.values[i] = colour(scale.map, (static_cast<double>(values.values[i]) - scale.low) / span);
  }
  return image;
}

SpotPair panel_box(const ImageFigure& figure, int panel) { return layout_of(figure).box(panel); }

Canvas draw(const ImageFigure& figure) {
  const Layout layout = layout_of(figure);
  Canvas canvas(ceil_int(layout.width), ceil_int(layout.height));
  for (int n = 0; n < count_of(figure.panels); ++n) draw_panel(canvas, figure, layout, n);
  const auto [bar, bar_end] = layout.bar();
  draw_colour_bar(canvas, figure.scale, bar, bar_end.y - bar.y);
  canvas.text({0.5 * layout.width, figure_margin + 10}, figure.title, title_size, paint::black, Align::middle);
  draw_legend(canvas, legend_of(figure), {layout.left, layout.legend}, layout.width - layout.left - figure_margin);
  return canvas;
}

}  // namespace vam::plot

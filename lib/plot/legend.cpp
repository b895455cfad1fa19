// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/legend.hpp"

#include <algorithm>

#include "plot/axis.hpp"

namespace vam::plot {

namespace {

constexpr double mark_width = 28;
constexpr double word_gap = 8;  // mark to words
constexpr double space = 24;    // entry to entry

double width_of(const LegendEntry& entry) {
  return (entry.mark == Mark::none ? 0 : mark_width + word_gap) + Canvas::text_width(entry.words, label_size);
}

/// The upper left corner of each entry, from (0, 0).
std::vector<Spot> places_of(const std::vector<LegendEntry>& entries, double width) {
  std::vector<Spot> places;
  Spot at;
  for (const LegendEntry& entry : entries) {
    const double needed = width_of(entry);
    if (at.x > 0 && at.x + needed > width) at = {0, at.y + legend_row};
    places.push_back(at);
    at.x += needed + space;
  }
  return places;
}

void draw_mark(Canvas& canvas, const LegendEntry& entry, Spot left) {
  const Spot right{left.x + mark_width, left.y};
  const Spot corner{left.x, left.y - 7};
  const Spot opposite{right.x, right.y + 7};
  switch (entry.mark) {
    case Mark::none:
      return;
    case Mark::line:
      return canvas.line(left, right, entry.colour, 2);
    case Mark::dashed:
      return canvas.dashed(left, right, entry.colour, 2);
    case Mark::dot:
      return canvas.disc({left.x + 0.5 * mark_width, left.y}, 4, entry.colour);
    case Mark::bar:
      canvas.fill(corner, opposite, entry.colour, 0.35);
      break;
    case Mark::patch:
      canvas.fill(corner, opposite, entry.colour);
      break;
    case Mark::hatch:
      canvas.hatch({{corner, opposite}});
      break;
    case Mark::outline:
      canvas.lines({{left, right}}, paint::black, 4);
      return canvas.lines({{left, right}}, paint::white, 2);
  }
  canvas.outline(corner, opposite, entry.mark == Mark::bar ? entry.colour : paint::grey);
}

}  // namespace

double legend_width(const std::vector<LegendEntry>& entries) {
  double widest = 0;
  for (const LegendEntry& entry : entries) widest = std::max(widest, width_of(entry));
  return widest;
}

double legend_height(const std::vector<LegendEntry>& entries, double width) {
  return entries.empty() ? 0 : places_of(entries, width).back().y + legend_row;
}

void draw_legend(Canvas& canvas, const std::vector<LegendEntry>& entries, Spot corner, double width) {
  const std::vector<Spot> places = places_of(entries, width);
  for (std::size_t n = 0; n < entries.size(); ++n) {
    Spot at{corner.x + places[n].x, corner.y + places[n].y + 0.5 * legend_row};
    draw_mark(canvas, entries[n], at);
    if (entries[n].mark != Mark::none) at.x += mark_width + word_gap;
    canvas.text(at, entries[n].words, label_size);
  }
}

}  // namespace vam::plot

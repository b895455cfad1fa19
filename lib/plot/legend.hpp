// SPDX-License-Identifier: GPL-3.0-or-later
// What the lines and colours of a figure mean, in rows beside it, so that nothing is covered.
#pragma once

#include <string>
#include <vector>

#include "plot/canvas.hpp"

namespace vam::plot {

enum class Mark { none, line, dashed, dot, bar, patch, hatch, outline };

struct LegendEntry {
  Mark mark = Mark::none;
  Rgb colour = paint::black;
  std::string words;
};

/// That of the widest entry.
[[nodiscard]] double legend_width(const std::vector<LegendEntry>& entries);
/// As many rows as fit the width, each of `legend_row` pixels. No entries: 0.
[[nodiscard]] double legend_height(const std::vector<LegendEntry>& entries, double width);
/// From the upper left corner.
void draw_legend(Canvas& canvas, const std::vector<LegendEntry>& entries, Spot corner, double width);

inline constexpr double legend_row = 22;

}  // namespace vam::plot

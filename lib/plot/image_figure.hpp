// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of images: one, or a sheet of many, with axes, colour bar and outlines.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "base/pixels.hpp"
#include "plot/axis.hpp"
#include "plot/colour_map.hpp"
#include "plot/contour.hpp"
#include "plot/legend.hpp"

namespace vam::plot {

struct ColourScale {
  ColourMap map = ColourMap::viridis;
  double low = 0;  // value at the lower end of the colours
  double high = 1;
  std::string label;                // beside the colour bar: "dose (mJ/cm3)"; no bar when empty
  std::optional<double> mark = {};  // a red line across the bar
};

struct Panel {
  Image values;         // row 0 at the top
  std::string caption;  // above the image, on a sheet
  std::vector<ContourPiece> outline;
  Image hatched = {};                     // hatched from 1/2 on; none when empty
  Image shaded = {};                      // 0...1: mixed with orange; none when empty
  RgbImage picture = {};                  // instead of the values in their colours
  std::optional<ColourScale> scale = {};  // instead of that of the figure, with a bar of its own
};

struct ImageFigure {
  std::string title;
  std::vector<Panel> panels;  // of one size
  Axis x;                     // from the left edge of the first column to the right edge of the last
  Axis y;                     // from the lower edge of the last row to the upper edge of the first
  bool square_pixels = true;  // false: the image may be stretched (columns against angles)
  ColourScale scale;
  std::string outline_name;              // in the legend; none when empty
  std::string hatched_name;              // the same
  std::vector<LegendEntry> legend = {};  // behind these
  int columns = 0;                       // of a sheet; 0: as many as make it about 4 : 3
  int size = 720;                        // pixels of the longer side of the image, about
};

[[nodiscard]] Canvas draw(const ImageFigure& figure);

/// Where draw() puts the image of a panel.
[[nodiscard]] SpotPair panel_box(const ImageFigure& figure, int panel);

/// The values as colours, pixel for pixel, without anything around them.
[[nodiscard]] RgbImage coloured(const Image& values, const ColourScale& scale);

}  // namespace vam::plot

// Figures of images: one with axes, or a sheet of many; with colour bar, scale bar and outlines.
#pragma once

#include <string>
#include <vector>

#include "base/image.hpp"
#include "base/pixels.hpp"
#include "plot/axis.hpp"
#include "plot/colour_map.hpp"
#include "plot/contour.hpp"

namespace vam::plot {

struct Panel {
  Image values;         // row 0 at the top
  std::string caption;  // above the image, on a sheet
  std::vector<ContourPiece> outline;
  Image hatched = {};  // hatched from 1/2 on; none when empty
  Image shaded = {};   // 0...1: mixed with orange; none when empty
};

struct ImageFigure {
  std::string title;
  std::vector<Panel> panels;  // of one size; a single one has axes, several become a sheet
  Axis x;                     // from the left edge of the first column to the right edge of the last
  Axis y;                     // from the lower edge of the last row to the upper edge of the first
  bool square_pixels = true;  // false: the image may be stretched (columns against angles)
  ColourMap colours = ColourMap::viridis;
  double low = 0;  // value at the lower end of the colours
  double high = 1;
  std::string value_label;   // beside the colour bar: "dose / mJ cm-3"
  std::string outline_name;  // below the image; none when empty
  std::string hatched_name;  // beside it
  double pixel_mm = 0;       // for a scale bar; none when 0
  int columns = 0;           // of a sheet; 0: as many as make it about 4 : 3
  int size = 720;            // pixels of the longer side of the image, about
};

[[nodiscard]] RgbImage draw(const ImageFigure& figure);

/// The values as colours, pixel for pixel, without anything around them.
[[nodiscard]] RgbImage coloured(const Image& values, ColourMap map, double low, double high);

}  // namespace vam::plot

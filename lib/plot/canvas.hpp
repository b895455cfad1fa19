// SPDX-License-Identifier: GPL-3.0-or-later
// A sheet to draw on: lines, text and images, kept as they are drawn, for pixels of any density or a vector file.
// Places are in pixels of 1/96 inch from the upper left corner, fractions allowed.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/pixels.hpp"

namespace vam::plot {

namespace paint {
inline constexpr Rgb black{0, 0, 0};
inline constexpr Rgb white{255, 255, 255};
inline constexpr Rgb grey{128, 128, 128};
inline constexpr Rgb light_grey{220, 220, 220};
// Distinct also for colour-blind eyes: the palette of Okabe and Ito.
inline constexpr Rgb blue{0, 114, 178};
inline constexpr Rgb orange{230, 159, 0};
inline constexpr Rgb green{0, 158, 115};
inline constexpr Rgb vermilion{213, 94, 0};
}  // namespace paint

struct Spot {
  double x = 0;
  double y = 0;
};

using SpotPair = std::pair<Spot, Spot>;

enum class Align { begin, middle, end };

inline constexpr double screen_dpi = 96;

class Canvas {
 public:
  /// Throws Fault::absent where cairo and pango are not installed.
  Canvas(int width, int height, Rgb background = paint::white);
  Canvas(Canvas&& other) noexcept;
  Canvas& operator=(Canvas&& other) noexcept;
  ~Canvas();

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;

  /// Lines along an axis take whole pixels of the screen.
  void line(Spot from, Spot to, Rgb colour, double thickness = 1);
  void dashed(Spot from, Spot to, Rgb colour, double thickness = 1);
  void lines(const std::vector<SpotPair>& pieces, Rgb colour, double thickness = 1);
  void polyline(const std::vector<Spot>& spots, Rgb colour, double thickness = 1);
  /// Mixes the colour in with this opacity.
  void fill(Spot corner, Spot opposite, Rgb colour, double opacity = 1);
  void area(const std::vector<Spot>& spots, Rgb colour, double opacity = 1);
  /// Black strokes on grey in these boxes, corner and opposite corner.
  void hatch(const std::vector<SpotPair>& boxes);
  void outline(Spot corner, Spot opposite, Rgb colour, double thickness = 1);
  void disc(Spot centre, double radius, Rgb colour);
  /// Stretches an image over a box: pixels that are enlarged stay boxes, others are averaged.
  void paste(const RgbImage& image, Spot corner, Spot opposite);
  /// Draws another canvas with its upper left corner there.
  void place(const Canvas& other, Spot corner);

  /// UTF-8 of `size` pixels, one line. `at` is where `horizontal` and `vertical` say: its beginning, middle or end; the
  /// beginning is left, and the top of the capital letters; the end is right, and the line they stand on. upwards turns
  /// it by 90 degrees anticlockwise, and the alignments with it.
  void text(Spot at, const std::string& words, double size, Rgb colour = paint::black, Align horizontal = Align::begin,
            Align vertical = Align::middle, bool upwards = false);
  [[nodiscard]] static double text_width(const std::string& words, double size);

  /// Pixels at this density. Throws Fault::usage above 32767 a side.
  [[nodiscard]] RgbImage image(double dpi = screen_dpi) const;
  /// The bytes of a file; `history` becomes its description.
  [[nodiscard]] std::string pdf(const std::string& history) const;
  [[nodiscard]] std::string svg(const std::string& history) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::plot

// A sheet to draw on: anti-aliased lines and text, in pixels from the top left, fractions allowed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/pixels.hpp"

namespace vam::plot {

namespace paint {
inline constexpr Rgb black{0, 0, 0};
inline constexpr Rgb white{255, 255, 255};
inline constexpr Rgb grey{128, 128, 128};
inline constexpr Rgb light_grey{220, 220, 220};
// Distinct also for colour-blind eyes [OI08].
inline constexpr Rgb blue{0, 114, 178};
inline constexpr Rgb orange{230, 159, 0};
inline constexpr Rgb green{0, 158, 115};
inline constexpr Rgb vermilion{213, 94, 0};
}  // namespace paint

struct Spot {
  double x = 0;
  double y = 0;
};

enum class Align { begin, middle, end };

class Canvas {
 public:
  Canvas(int width, int height, Rgb background = paint::white);
  ~Canvas();

  [[nodiscard]] int width() const;
  [[nodiscard]] int height() const;

  void line(Spot from, Spot to, Rgb colour, double thickness = 1);
  void dashed(Spot from, Spot to, Rgb colour, double thickness = 1);
  void polyline(const std::vector<Spot>& spots, Rgb colour, double thickness = 1);
  /// Mixes the colour in with this opacity.
  void fill(Spot corner, Spot opposite, Rgb colour, double opacity = 1);
  void outline(Spot corner, Spot opposite, Rgb colour, double thickness = 1);
  void disc(Spot centre, double radius, Rgb colour);
  /// Copies an image with its top left pixel at (x, y); what does not fit is left out.
  void paste(const RgbImage& image, int x, int y);

  /// ASCII text of `size` pixels a line. `at` is where `horizontal` and `vertical` say: its beginning, middle or end;
  /// the beginning is left and top. upwards turns it by 90 degrees anticlockwise, and the alignments with it.
  void text(Spot at, const std::string& words, double size, Rgb colour = paint::black, Align horizontal = Align::begin,
            Align vertical = Align::middle, bool upwards = false);
  [[nodiscard]] static double text_width(const std::string& words, double size);

  [[nodiscard]] RgbImage image() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vam::plot

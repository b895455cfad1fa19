#include "io/chart.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace vam;

namespace {

constexpr Rgb white{255, 255, 255};
constexpr Rgb red{255, 0, 0};

long count(const RgbImage& canvas, Rgb colour) {
  long pixels = 0;
  for (const Rgb& value : canvas.values) pixels += value == colour;
  return pixels;
}

}  // namespace

TEST_CASE("data land where the axes say") {
  RgbImage canvas(300, 200, white);
  io::Chart chart(canvas, {80, 40, 200, 100}, {"x", 0, 10}, {"y", 1, 100, true}, "title");
  const std::vector<double> x{5};
  const std::vector<double> y{10};
  chart.dots(x, y, red, 3);
  CHECK(canvas(180, 90) == red);  // the middle of both axes, the logarithmic one too
  CHECK(canvas(180, 99) != red);
}

TEST_CASE("what lies outside the axes is cut off") {
  RgbImage canvas(300, 200, white);
  io::Chart chart(canvas, {80, 40, 200, 100}, {"", 0, 1}, {"", 0, 1}, "");
  const std::vector<double> x{-5, 6};
  const std::vector<double> y{0.4, 0.5};
  chart.line(x, y, red, 5);
  CHECK(count(canvas, red) > 0);
  for (int row = 0; row < canvas.height; ++row) {
    for (int column = 0; column < canvas.width; ++column) {
      const bool inside = column >= 80 && column <= 280 && row >= 40 && row <= 140;
      if (!inside) CHECK(canvas(column, row) != red);
    }
  }
  const long before = count(canvas, red);
  const std::vector<double> far_x{20};
  const std::vector<double> far_y{0.5};
  chart.dots(far_x, far_y, red);
  CHECK(count(canvas, red) == before);
}

TEST_CASE("a picture fills the frame without smoothing") {
  RgbImage canvas(300, 200, white);
  io::Chart chart(canvas, {80, 40, 200, 100}, {"", 0, 1}, {"", 0, 1}, "");
  RgbImage two(2, 1);
  two(0, 0) = red;
  two(1, 0) = {0, 0, 255};
  chart.picture(two);
  CHECK(canvas(81, 41) == red);
  CHECK(canvas(178, 100) == red);
  CHECK(canvas(182, 100) == Rgb{0, 0, 255});
  CHECK(count(canvas, red) == 99 * 99);  // half of the frame, less its border
}

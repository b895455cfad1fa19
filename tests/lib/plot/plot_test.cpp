// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/plot.hpp"

#include <cstdlib>

#include "io/image/image_file.hpp"
#include "plot/image_figure.hpp"
#include "testing.hpp"

using namespace vam::io;
using namespace vam::plot;
using vam::Rgb;
using vam::RgbImage;

namespace {

int count(const RgbImage& image, Rgb colour) {
  return static_cast<int>(std::count(image.values.begin(), image.values.end(), colour));
}

// Figures to look at, when $VAM_IMAGES names a folder.
void keep(const RgbImage& image, const std::string& name) {
  if (const char* folder = std::getenv("VAM_IMAGES")) write_png(std::string(folder) + "/" + name, image);
}

}  // namespace

TEST_CASE("ticks are round numbers, inside the axis, about as many as requested") {
  CHECK(ticks({"", 0, 10, false}, 5) == std::vector<double>{0, 2, 4, 6, 8, 10});
  CHECK(ticks({"", -1, 1, false}, 4) == std::vector<double>{-1, -0.5, 0, 0.5, 1});
  CHECK(ticks({"", 10, 0, false}, 5).size() == 6);
  CHECK(ticks({"", -4.4, 4.4, false}, 2) == std::vector<double>{-4, -2, 0, 2, 4});  // not 0 alone
  CHECK(ticks({"", 1, 1000, true}, 5) == std::vector<double>{1, 10, 100, 1000});
  for (double span = 1e-3; span < 1e4; span *= 1.7) {
    const auto values = ticks({"", 0.3 * span, 1.3 * span, false}, 6);
    CHECK(values.size() >= 3);
    CHECK(values.size() <= 11);
    CHECK(values.front() >= 0.3 * span - 1e-9);
    CHECK(values.back() <= 1.3 * span + 1e-6 * span);
  }
  CHECK(round_step(0.7) == doctest::Approx(0.5));
  CHECK(round_step(23) == doctest::Approx(20));
}

TEST_CASE("ticks of counts are whole numbers") {
  CHECK(ticks({"", 0, 2, false, 0, true}, 8) == std::vector<double>{0, 1, 2});
  CHECK(ticks({"", 0, 100, false, 0, true}, 5) == ticks({"", 0, 100}, 5));
}

TEST_CASE("a frame maps values to positions, y upwards, also on logarithmic axes") {
  const PlotFrame frame{100, 50, 300, 250, {"", 0, 10, false}, {"", 1, 100, true}};
  CHECK(frame.spot_x(5) == 200);
  CHECK(frame.spot_y(1) == 250);
  CHECK(frame.spot_y(10) == doctest::Approx(150));
  CHECK(frame.spot_y(100) == doctest::Approx(50));
}

TEST_CASE("a curve is where its values are") {
  Plot plot{
      .title = "a parabola, and points of a line", .x = {"x / mm", 0, 10, false}, .y = {"y / mm2", 0, 100, false}};
  Series parabola{"x squared", {}, {}, paint::blue, SeriesStyle::line};
  Series points{"8 x", {}, {}, paint::orange, SeriesStyle::points};
  for (int i = 0; i <= 100; ++i) {
    parabola.x.push_back(i / 10.0);
    parabola.y.push_back(i * i / 100.0);
    if (i % 10 == 0) points.x.push_back(i / 10.0), points.y.push_back(8 * i / 10.0);
  }
  plot.series = {parabola, points};
  plot.markers = {{5, "half way", paint::green}};
  const RgbImage image = draw(plot).image();
  keep(image, "curve.png");
  CHECK(image.width == 900);
  const PlotFrame frame = frame_of(plot);
  const int x = static_cast<int>(frame.left + 0.7 * (frame.right - frame.left));
  const int y = static_cast<int>(frame.bottom - 0.49 * (frame.bottom - frame.top));  // the parabola at x = 7
  bool found = false;
  for (int dy = -2; dy <= 2; ++dy) found = found || image(x, y + dy) == paint::blue;
  CHECK(found);
  CHECK(image(x, y + 60) != paint::blue);
  CHECK(count(image, paint::orange) > 11 * 15);
  CHECK(count(image, paint::green) > 50);
}

TEST_CASE("histograms count shares and draw bars") {
  HistogramBuilder builder(0, 1, 4);
  for (const double value : {-3.0, 0.1, 0.3, 0.3, 0.9, 1.0, 7.0, 0.6}) builder.add(value);
  const Histogram histogram = builder.done();
  CHECK(histogram.edges == std::vector<double>{0, 0.25, 0.5, 0.75, 1});
  CHECK(histogram.percent == std::vector<double>{25, 25, 12.5, 37.5});
  Plot plot{"histogram", {"dose", 0, 1, false}, {"share of the voxels / %", 0, 0, false}, {}, {}, {}, 600, 400};
  plot.series = {{"in part", histogram.edges, histogram.percent, paint::vermilion, SeriesStyle::bars},
                 {"out of part", histogram.edges, {40, 30, 20, 10}, paint::blue, SeriesStyle::bars}};
  const RgbImage image = draw(plot).image();
  keep(image, "histogram.png");
  // The last bin is 37.5 of 42 % high.
  const PlotFrame frame = frame_of(plot);
  const int x = static_cast<int>(frame.spot_x(0.95));
  CHECK(image(x, static_cast<int>(frame.spot_y(36))) != paint::white);
  CHECK(image(x, static_cast<int>(frame.spot_y(39))) == paint::white);
}

TEST_CASE("an image that is enlarged one way fills its box and nothing beyond") {
  Canvas canvas(40, 40);
  canvas.paste(RgbImage(1, 100, paint::blue), {10, 10}, {30, 30});
  const RgbImage shown = canvas.image();
  for (const auto [y, x] : indices(40, 40)) {
    const bool inside = x >= 10 && x < 30 && y >= 10 && y < 30;
    CHECK(shown(x, y) == (inside ? paint::blue : paint::white));
  }
}

TEST_CASE("a narrow figure is as wide as its legend") {
  const std::string words = "0.1 % of the pixels are above what the colours of this narrow figure show";
  ImageFigure figure;
  figure.panels.push_back({vam::Image(4, 100), "", {}});
  figure.legend = {{Mark::none, paint::black, words}};
  CHECK(draw(figure).width() > Canvas::text_width(words, label_size) + 28);
}

TEST_CASE("text has the reported width, can be vertical, and stays on the canvas") {
  Canvas canvas(200, 200);
  canvas.text({10, 100}, "Hxg", 20);
  const double width = Canvas::text_width("Hxg", 20);
  CHECK(width > 25);
  CHECK(width < 45);
  const RgbImage across = canvas.image();
  int right = 0;
  for (const auto [y, x] : indices(200, 200)) right = across(x, y) != paint::white ? std::max(right, x) : right;
  CHECK(std::abs(right - (10 + width)) < 5);
  Canvas upright(200, 200);
  upright.text({100, 190}, "Hxg", 20, paint::black, Align::begin, Align::middle, true);
  const RgbImage along = upright.image();
  int top = 200;
  for (int y = 199; y >= 0; --y) {
    for (int x = 0; x < 200; ++x) top = along(x, y) != paint::white ? y : top;
  }
  CHECK(std::abs(top - (190 - width)) < 6);
  canvas.text({-500, 900}, "beyond", 20);  // must not write outside
  canvas.line({-100, -100}, {400, 500}, paint::blue);
}

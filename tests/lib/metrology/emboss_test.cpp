// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/emboss.hpp"

#include <limits>

#include "base/constants.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

// The design's pixels differ from the image's, and no edge falls on their middles.
// A flag on a disc, 1 where it stands out: a bar with an arm and a dot; no turn maps it onto itself.
bool stands_out(double x, double y) {
  const bool bar = std::abs(x + 2) < 0.7 && std::abs(y) < 3;
  const bool arm = std::abs(y - 2) < 0.6 && x > -2 && x < 2.5;
  return bar || arm || std::hypot(x - 1.5, y + 1.5) < 0.9;
}

solid::HeightMap design(double pixel_mm) {
  const int n = static_cast<int>(9 / pixel_mm) | 1;
  solid::HeightMap map{Image(n, n), pixel_mm, -0.5 * (n - 1) * pixel_mm, 0.5 * (n - 1) * pixel_mm};
  for (const auto [j, i] : indices(n, n)) {
    const double x = map.x_mm + i * pixel_mm;
    const double y = map.y_mm - j * pixel_mm;
    map.heights_mm(i, j) =
        std::hypot(x, y) > 4.3 ? std::numeric_limits<float>::quiet_NaN() : (stands_out(x, y) ? 4.25F : 3.6F);
  }
  return map;
}

struct Print {
  double scale = 1;
  double turn_deg = 0;
  double x_mm = 0;
  double y_mm = 0;
  double noise_mm = 0;
};

// The image of a print of it: 0.35 mm high, lying askew, with a few lost readings.
Image image(const Print& print, double pixel_mm) {
  Image image(240, 260);
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, print.noise_mm);
  std::uniform_real_distribution<double> unit(0, 1);
  const double c = std::cos(print.turn_deg * rad_per_deg) / print.scale;
  const double s = std::sin(print.turn_deg * rad_per_deg) / print.scale;
  for (const auto [j, i] : indices(image.height, image.width)) {
    const double x = (i - 119.5) * pixel_mm - print.x_mm;
    const double y = (129.5 - j) * pixel_mm - print.y_mm;
    const double height = stands_out(c * x + s * y, c * y - s * x) ? 0.35 : 0.0;
    const double noise = print.noise_mm > 0 ? normal(random) : 0;
    image(i, j) = static_cast<float>(1 + 0.002 * i - 0.001 * j + height + noise);
    if (unit(random) < 0.01) image(i, j) = std::numeric_limits<float>::quiet_NaN();
  }
  return image;
}

}  // namespace

TEST_CASE("shrinkage, turn, shift and height of an embossed print are found in its height image") {
  const double pixel_mm = 0.05;
  const Print print{0.985, 97, 0.4, -0.7, 0.01};
  const Relief relief = levelled(image(print, pixel_mm), pixel_mm);
  CHECK(relief.tilt_deg == doctest::Approx(std::atan(std::hypot(0.002, 0.001) / pixel_mm) * deg_per_rad).epsilon(0.01));
  const Emboss found = compare_emboss(relief, design(0.037), EmbossAlign::any_turn);
  MESSAGE("scale ", found.placing.scale, ", turn ", found.placing.turn_deg, ", outline RMS ", found.outline_rms_mm);
  CHECK(found.placing.scale == doctest::Approx(print.scale).epsilon(0.001));  // a tenth of a per cent: 0.06 pixels
  CHECK(found.placing.turn_deg == doctest::Approx(print.turn_deg).epsilon(0.001));
  CHECK(std::abs(found.placing.shift_x_mm - print.x_mm) < 0.1 * pixel_mm);
  CHECK(std::abs(found.placing.shift_y_mm - print.y_mm) < 0.1 * pixel_mm);
  CHECK(found.outline_rms_mm < 0.5 * pixel_mm);  // the outline is known to the pixel
  CHECK(std::abs(found.outline_mean_mm) < 0.1 * pixel_mm);
  CHECK(found.height_mm == doctest::Approx(0.35).epsilon(0.01));
  CHECK(found.height_sigma_mm == doctest::Approx(print.noise_mm).epsilon(0.1));
  CHECK(found.design_height_mm == doctest::Approx(0.65).epsilon(1e-4));
  CHECK(found.iou > 0.95);
}

TEST_CASE("soft edges and dents of the base do not change the height") {
  const double pixel_mm = 0.05;
  Image sharp = image({1, 0, 0, 0, 0.004}, pixel_mm);
  for (std::size_t i = 1; i < sharp.size(); ++i) {
    if (!std::isfinite(sharp.values[i])) sharp.values[i] = sharp.values[i - 1];
  }
  Image seen = sharp;  // the mean of 7 x 7 pixels, as of a wide probe
  constexpr int reach = 3;
  for (int j = reach; j + reach < seen.height; ++j) {
    for (int i = reach; i + reach < seen.width; ++i) {
      float sum = 0;
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) sum += sharp(i + x, j + y) / 49;
      }
      seen(i, j) = sum;
    }
  }
  for (int dent = 0; dent < 12; ++dent) {  // 5 % of the base, 0.1 mm deep, at its right edge
    for (const auto [y, x] : indices(16, 16)) seen(222 + x, 8 + 20 * dent + y) -= 0.1F;
  }
  const Relief relief = levelled(seen, pixel_mm);
  const Emboss found = compare_emboss(relief, design(0.037), EmbossAlign::near);
  MESSAGE("height ", found.height_mm);
  CHECK(found.height_mm == doctest::Approx(0.35).epsilon(0.003));  // noise of 0.0006 mm a pixel, averaged
}

TEST_CASE("without alignment the pose shows in the outline") {
  const double pixel_mm = 0.05;
  const Relief relief = levelled(image({1, 0, 0.3, 0, 0}, pixel_mm), pixel_mm);
  const Emboss found = compare_emboss(relief, design(0.037), EmbossAlign::none);
  CHECK(found.placing.scale == 1);
  CHECK(found.outline_max_mm == doctest::Approx(0.3).epsilon(0.15));  // a pixel is 0.05 mm
  const Emboss near = compare_emboss(relief, design(0.037), EmbossAlign::near);
  CHECK(std::abs(near.placing.shift_x_mm - 0.3) < 0.1 * pixel_mm);
}

TEST_CASE("a section shows print and design") {
  const double pixel_mm = 0.05;
  const Relief relief = levelled(image({1, 0, 0, 0, 0}, pixel_mm), pixel_mm);
  const Emboss found = compare_emboss(relief, design(0.037), EmbossAlign::near);
  const Section line = section(relief, found, 0, 129, 239, 129);
  CHECK(line.along_mm.back() == doctest::Approx(239 * pixel_mm));
  const auto highest = [](const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); };
  CHECK(highest(line.print_mm) == doctest::Approx(0.35).epsilon(0.02));
  CHECK(highest(line.design_mm) == doctest::Approx(0.65).epsilon(1e-4));
}

TEST_CASE("images and designs without relief are errors") {
  CHECK_THROWS_WITH_AS((void)levelled(Image(50, 50, 1.0F), 0.05), doctest::Contains("flat"), Error);
  CHECK_THROWS_WITH_AS((void)levelled(Image(50, 50, std::numeric_limits<float>::quiet_NaN()), 0.05),
                       doctest::Contains("0 of 2500"), Error);
  const Relief relief = levelled(image({}, 0.05), 0.05);
  solid::HeightMap flat = design(0.037);
  for (float& h : flat.heights_mm.values) h = 1;
  CHECK_THROWS_WITH_AS((void)compare_emboss(relief, flat, EmbossAlign::near), doctest::Contains("flat"), Error);
}

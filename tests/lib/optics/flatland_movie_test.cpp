// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/flatland_movie.hpp"

#include "testing.hpp"

using namespace vam::optics;

TEST_CASE("a smeared projection has the value of the detector's place under each pixel, and is dark beside it") {
  const std::vector<float> ramp{0, 1, 2, 3, 4, 5, 6, 7, 8};  // the value is the place
  const ImagePlane canvas{14, 11, 0.2, 6.25, 4.5};
  const double detector_mm = 0.25;
  for (const double angle : {0.0, 0.4, std::numbers::pi / 2, 3.5}) {
    const vam::Image image = smear(ramp, detector_mm, angle, canvas);
    REQUIRE(image.width == 14);
    REQUIRE(image.height == 11);
    for (const auto [r, c] : indices(image.height, image.width)) {
      const double x = (c - canvas.axis_column) * canvas.pixel_mm;
      const double y = (canvas.axis_row - r) * canvas.pixel_mm;
      const double place = 4 + (x * std::cos(angle) + y * std::sin(angle)) / detector_mm;
      CAPTURE(angle);
      CAPTURE(place);
      if (std::abs(place) < 1e-9 || std::abs(place - 8) < 1e-9) continue;  // the last pixel may be lit or dark
      CHECK(image(c, r) == doctest::Approx(place >= 0 && place <= 8 ? place : 0).epsilon(1e-5));
    }
  }
}

TEST_CASE("the projection at an angle is that of the row, between two rows their mean, and of a turn without an end") {
  vam::model::StackInfo info{.angle_start_deg = 10, .angle_step_deg = 45};
  vam::Image sinogram(3, 8);
  for (const auto [a, c] : indices(8, 3)) sinogram(c, a) = static_cast<float>(a + 10 * c);
  const auto at = [&](double angle_deg, double span_deg) { return projection_at(sinogram, info, angle_deg, span_deg); };
  for (int c = 0; c < 3; ++c) {
    const auto column = static_cast<std::size_t>(c);
    CHECK(at(10 + 3 * 45, 0)[column] == doctest::Approx(3 + 10 * c));
    CHECK(at(10 + 3.25 * 45, 0)[column] == doctest::Approx(3.25 + 10 * c));
    CHECK(at(10 + 3.25 * 45, 135)[column] == doctest::Approx(3.25 + 10 * c));  // the rows rise evenly
    CHECK(at(10 + 7.5 * 45, 0)[column] == doctest::Approx(3.5 + 10 * c));      // of the last row and the first
    CHECK(at(10 - 1 * 45, 0)[column] == doctest::Approx(7 + 10 * c));
    CHECK(at(10 - 9 * 45, 0)[column] == doctest::Approx(7 + 10 * c));
    CHECK(at(10, 360)[column] == doctest::Approx(3.5 + 10 * c));  // all
  }
  info.angle_step_deg = -45;
  CHECK(at(10 - 3.25 * 45, 135)[0] == doctest::Approx(3.25));
}

TEST_CASE("the canvas has its axis in the middle of the projector's image, moved by the offsets") {
  const ImagePlane canvas = flatland_canvas(vam::model::Projector{.columns = 10, .rows = 7, .pixel_mm = 0.3}, 1.5, -2);
  CHECK(canvas.columns == 10);
  CHECK(canvas.rows == 7);
  CHECK(canvas.pixel_mm == 0.3);
  CHECK(canvas.axis_column == 6);
  CHECK(canvas.axis_row == 1);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot/render.hpp"

#include <cstdlib>

#include "plot/canvas.hpp"
#include "testing.hpp"

using namespace vam::plot;
using vam::Rgb;

TEST_CASE("a flat face is of one shade up to its edges, and a round one is smooth") {
  // A plate of 4 x 4 x 0.4 mm, whose top is much larger than its sides.
  Body plate;
  for (int n = 0; n < 8; ++n) plate.mesh.points.push_back({n % 2 ? 2.0 : -2.0, n & 2 ? 2.0 : -2.0, n & 4 ? 0.2 : -0.2});
  plate.mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                          {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  const vam::RgbImage image = render({&plate}, {0, 0, 0}, 6, {0, 60}, 120);
  const Rgb top = image(60, 60);
  CHECK(top != paint::white);
  CHECK(image(22, 60) == top);
  CHECK(image(97, 60) == top);
  CHECK(image(60, 30) == top);
  // A roof of 20 degrees: its ridge is rounded.
  Body roof;
  roof.mesh.points = {{-2, -2, 0}, {2, -2, 0}, {2, 0, 0.36}, {-2, 0, 0.36}, {2, 2, 0}, {-2, 2, 0}};
  roof.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {3, 2, 4}, {3, 4, 5}};
  const vam::RgbImage round = render({&roof}, {0, 0, 0}, 6, {0, 90}, 120);
  CHECK(std::abs(round(60, 58)[0] - round(60, 62)[0]) <= 2);
  CHECK(round(60, 25) != round(60, 95));
}

TEST_CASE("a body is seen from above at its size, what is nearer before what is farther") {
  // A square of 2 mm in the plane y = 0, and a small one before it, at y = -1, from the front.
  const auto square = [](double half, double y, Rgb colour) {
    return Body{{{{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}}, {{0, 1, 2}, {0, 2, 3}}},
                std::vector<Rgb>(4, colour)};
  };
  const Body far = square(1, 0, {200, 0, 0});
  const Body near = square(0.25, -1, {0, 0, 200});
  const vam::RgbImage image = render({&near, &far}, {0, 0, 0}, 4, {0, 0}, 80);  // 20 pixels per mm
  CHECK(image(2, 40) == paint::white);
  CHECK(image(19, 40) == paint::white);
  CHECK(image(20, 40)[0] > 60);
  CHECK(image(59, 40)[0] > 60);
  CHECK(image(60, 40) == paint::white);
  CHECK(image(40, 40)[2] > 60);
  CHECK(image(40, 40)[0] == 0);
  CHECK(image(46, 40)[0] > 60);
  const vam::RgbImage above = render({&far}, {0, 0, 0}, 4, {0, 60}, 80);  // cos 60 deg: half as high
  CHECK(above(40, 29) == paint::white);
  CHECK(above(40, 31) != paint::white);
  CHECK(side_mm({&far}, {0, 0, 0}, {0, 60}) == doctest::Approx(2));
}

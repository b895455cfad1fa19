// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/prolongation.hpp"

#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;

namespace {

double turn(double deg) { return std::cos(deg * std::numbers::pi / 180); }

}  // namespace

TEST_CASE("a finer stack is the coarser one between its samples") {
  // Pairs of finer columns, angles and slices, as model::coarser() joins them.
  const StackSamples from{{8, -3.5, 1}, {90, 0, 4}, {3, 10, 2}};
  const StackSamples to{{16, -3.75, 0.5}, {180, 0, 2}, {6, 9.5, 1}};
  std::vector<Image> coarse(3, Image(8, 90));
  const auto value = [](double column, double deg, double slice) { return 2 * column + 3 * turn(deg) + slice; };
  for (const auto [k, a, c] : indices(3, 90, 8))
    coarse[k](c, a) = static_cast<float>(value(-3.5 + c, 4 * a, 10 + 2 * k));
  const Prolongation finer(coarse, from, to);
  // Linear in columns and slices, so exact between the coarser samples; a cosine's chord is below it by (2 deg)^2 / 2.
  for (int k = 1; k < 5; ++k) {
    const Image image = finer(k);
    REQUIRE(image.width == 16);
    REQUIRE(image.height == 180);
    for (const int a : {0, 1, 77, 178, 179}) {  // the last lies between the last and the first
      for (int c = 1; c < 15; ++c) {
        CHECK(static_cast<double>(image(c, a)) ==
              doctest::Approx(value(-3.75 + 0.5 * c, 2 * a, 9.5 + k)).epsilon(1e-4).scale(20));
      }
    }
  }
  CHECK(finer(0)(0, 0) == doctest::Approx(static_cast<double>(coarse[0](0, 0))));  // beyond the ends they go on
  CHECK(finer(5)(15, 0) == doctest::Approx(static_cast<double>(coarse[2](7, 0))));
}

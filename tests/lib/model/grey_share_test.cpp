// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/dose/grey_share.hpp"

#include "testing.hpp"

using namespace vam;

namespace {

double share(const std::function<double(double x, double y, double z)>& value) {
  const model::Grid grid = model::centred_grid(24, 24, 24, 1, -11.5);
  return model::grey_share(grid, [&](int k, float* out) {
    for (const auto [j, i] : indices(grid.ny, grid.nx))
      *out++ = static_cast<float>(value(grid.x_mm(i), grid.y_mm(j), grid.z_mm(k)));
  });
}

}  // namespace

TEST_CASE("coverage is not grey, whichever way its faces look") {
  for (const auto& [x, y, z] : {std::array{1.0, 1.0, 1.0}, std::array{1.0, 0.0, 0.0}, std::array{0.0, 0.0, 1.0},
                                std::array{3.0, 2.0, 1.0}, std::array{1.0, 1.0, 0.1}}) {
    const double length = std::hypot(x, y, z);
    const double width = (x + y + z) / length;  // of the band of voxels that the plane cuts
    CHECK(share([&](double a, double b, double c) {
            return std::clamp(0.5 - (a * x + b * y + c * z) / length / width, 0.0, 1.0);
          }) == 0);
  }
}

TEST_CASE("a grey target by the share of what is inside it") {
  // A cube of 10 voxels of 0.4, whose own surface is not counted: 8 of them each way.
  const auto cube = [](double x, double y, double z) { return std::max({std::abs(x), std::abs(y), std::abs(z)}) < 5; };
  CHECK(share([&](double x, double y, double z) { return cube(x, y, z) ? 0.4 : 0; }) == doctest::Approx(0.512));
  CHECK(share([&](double x, double y, double z) { return cube(x, y, z) ? 1 : 0; }) == 0);
  CHECK(share([](double, double, double) { return 0; }) == 0);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/wall.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>

using namespace vam;

namespace {

model::Volume filled(int nx, int ny, int nz, const std::function<bool(int, int, int)>& inside) {
  model::Volume volume{{nx, ny, nz, 1.0, {}}, {}};
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) volume.values.push_back(inside(i, j, k) ? 1.0F : 0.0F);
    }
  }
  return volume;
}

}  // namespace

TEST_CASE("the thinnest wall of plates, also where a thick block stands on one, and across the axes") {
  for (const int n : {1, 2, 3, 4, 7, 8}) {
    const auto plate = filled(30, 30, 12, [n](int, int, int k) { return k >= 2 && k < 2 + n; });
    CHECK(*solid::thinnest_wall_voxels(plate) == doctest::Approx(n).epsilon(0.2 / n));  // steps of a quarter
    const auto upright = filled(12, 40, 40, [n](int i, int, int) { return i >= 1 && i < 1 + n; });
    CHECK(*solid::thinnest_wall_voxels(upright) == doctest::Approx(n).epsilon(0.2 / n));
  }
  const auto block_on_plate =
      filled(40, 40, 24, [](int i, int j, int k) { return k < 3 || (i > 10 && i < 28 && j > 10 && j < 28); });
  CHECK(*solid::thinnest_wall_voxels(block_on_plate) == doctest::Approx(3).epsilon(0.1));
  const auto tilted = filled(60, 60, 20, [](int i, int j, int) { return std::abs(i - j) <= 5; });
  CHECK(std::abs(*solid::thinnest_wall_voxels(tilted) - 11 / std::sqrt(2.0)) < 1);  // good to a voxel
}

TEST_CASE("a ball is as thick as its diameter: its rim is no wall") {
  const auto ball = filled(25, 25, 25, [](int i, int j, int k) { return std::hypot(i - 12, j - 12, k - 12) <= 10; });
  // Half of a voxel's diagonal at either end, and a step.
  CHECK(std::abs(*solid::thinnest_wall_voxels(ball) - 21) < std::sqrt(3.0) + 0.25);
  CHECK(!solid::thinnest_wall_voxels(filled(4, 4, 4, [](int, int, int) { return false; })));
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/insert.hpp"

#include <limits>

#include "testing.hpp"

using namespace vam::light;

TEST_CASE("a voxel is in shadow up to 1 % of the largest dose, and not above") {
  for (const float largest : {1.0F, 3.0F, 1e-3F}) {
    const float edge = 0.01F * largest;
    CHECK(in_shadow(0, largest));
    CHECK(in_shadow(0.99F * edge, largest));
    CHECK(in_shadow(edge, largest));  // the limit itself is dark
    CHECK_FALSE(in_shadow(std::nextafter(edge, largest), largest));
    CHECK_FALSE(in_shadow(largest, largest));
  }
}

TEST_CASE("a voxel with no light, or a dose that is not a number, is in shadow") {
  CHECK(in_shadow(0, 0));
  CHECK(in_shadow(std::numeric_limits<float>::quiet_NaN(), 1));
}

TEST_CASE("voxels covered by at least half are opaque and have no dose") {
  CHECK_FALSE(opaque(std::nextafter(0.5F, 0.0F)));
  CHECK(opaque(0.5F));
  struct Voxels {
    std::vector<float> values;
  };
  const Voxels insert{{0, 0.49F, 0.5F, 1}};
  Voxels dose{{1, 2, 3, 4}};
  darken(insert, dose);
  CHECK(dose.values == std::vector<float>{1, 2, 0, 0});
}

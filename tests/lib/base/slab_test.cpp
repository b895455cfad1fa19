// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/slab.hpp"

#include <doctest/doctest.h>

#include <numeric>
#include <vector>

using namespace vam;

TEST_CASE("pack puts image s into lane s and zeroes the rest; unpack undoes it") {
  const int count = 11;
  std::vector<float> images(std::size_t{37} * 23 * count);
  std::iota(images.begin(), images.end(), 1.0F);
  Slab slab(37, 23);
  std::fill(slab.values.begin(), slab.values.end(), -1.0F);
  pack(images.data(), count, slab);
  for (int s = 0; s < lanes; ++s) {
    for (int y = 0; y < 23; ++y) {
      for (int x = 0; x < 37; ++x) {
        const float want = s < count ? static_cast<float>(1 + x + 37 * (y + 23 * s)) : 0.0F;
        CHECK(slab.at(x, y)[s] == want);
      }
    }
  }
  std::vector<float> back(images.size(), 0.0F);
  unpack(slab, count, back.data());
  CHECK(back == images);
}

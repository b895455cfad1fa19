// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/compute/slab.hpp"

#include <numeric>

#include "testing.hpp"

using namespace vam;

TEST_CASE("pack puts image s into lane s and zeroes the rest; unpack undoes it") {
  const int count = 11;
  std::vector<float> images(std::size_t{37} * 23 * count);
  std::iota(images.begin(), images.end(), 1.0F);
  Slab slab(37, 23);
  std::fill(slab.values.begin(), slab.values.end(), -1.0F);
  pack(images.data(), count, slab);
  for (const auto [s, y, x] : indices(lanes, 23, 37)) {
    const float want = s < count ? static_cast<float>(1 + x + 37 * (y + 23 * s)) : 0.0F;
    CHECK(slab.at(x, y)[s] == want);
  }
  std::vector<float> back(images.size(), 0.0F);
  unpack(slab, count, back.data());
  CHECK(back == images);
}

TEST_CASE("rows side by side are 0 where there are none, and one by one they are what they were") {
  constexpr int stride = 24;
  for (const int given : {1, 4, 7, 16}) {
    for (const int count : {1, 4, 11}) {
      CAPTURE(given);
      CAPTURE(count);
      std::vector<std::vector<float>> rows(given, std::vector<float>(count));
      std::vector<const float*> from;
      for (int s = 0; s < given; ++s) {
        std::iota(rows[s].begin(), rows[s].end(), static_cast<float>(1 + 100 * s));
        from.push_back(rows[s].data());
      }
      std::vector<float> together(stride * count, -1.0F);
      const int wide = given <= 8 ? 8 : lanes;
      side_by_side(from, count, together.data(), stride, wide);
      for (const auto [i, s] : indices(count, stride)) {
        CHECK(together[i * stride + s] == (s >= wide ? -1.0F : s < given ? rows[s][i] : 0.0F));
      }
      std::vector<std::vector<float>> back(given, std::vector<float>(count));
      std::vector<float*> to;
      for (auto& row : back) to.push_back(row.data());
      one_by_one(together.data(), stride, count, to);
      CHECK(back == rows);
    }
  }
}

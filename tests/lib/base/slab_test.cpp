// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/compute/slab.hpp"

#include <numeric>

#include "base/compute/per_slice.hpp"
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

namespace {

// Two slabs of 3 x 2 voxels: value 1 + index in the slice + 10 slice, against sums and extremes by hand.
constexpr int width = 3;
constexpr int height = 2;
constexpr int slices = 18;  // two more than a slab has

std::vector<Image> numbered() {
  std::vector<Image> images;
  for (int k = 0; k < slices; ++k) {
    Image image(width, height);
    for (int i = 0; i < width * height; ++i) image.values[i] = static_cast<float>(1 + i + 10 * k);
    images.push_back(image);
  }
  return images;
}

}  // namespace

TEST_CASE("slices are packed in order, and reduced each on its own") {
  const std::vector<Slab> all = packed(numbered(), width, height);
  REQUIRE(all.size() == 2);
  const PerSlice least = minima(all);
  const PerSlice most = largest(all);
  const PerSlice sum = summed(all, [&](std::size_t s, std::size_t i) { return all[s].values[i]; });
  for (int k = 0; k < 2 * lanes; ++k) {
    CAPTURE(k);
    const float first = k < slices ? static_cast<float>(1 + 10 * k) : 0;
    CHECK(least[k / lanes][k % lanes] == first);
    CHECK(most[k / lanes][k % lanes] == (k < slices ? first + 5 : 0));
    CHECK(sum[k / lanes][k % lanes] == (k < slices ? 6 * first + 15 : 0));
    for (int i = 0; i < width * height; ++i) {
      CHECK(all[k / lanes].at(i % width, i / width)[k % lanes] == (k < slices ? first + static_cast<float>(i) : 0));
    }
  }
  for (const auto& lane : largest_of_all(most)) {
    for (const float value : lane) CHECK(value == 10 * (slices - 1) + 6);
  }
  std::vector<Image> wrong = numbered();
  wrong[4] = Image(width + 1, height);
  CHECK(fault_of([&] { (void)packed(wrong, width, height); }) == Fault::bug);
  wrong[4] = Image(width, height + 1);
  CHECK(fault_of([&] { (void)packed(wrong, width, height); }) == Fault::bug);
}

TEST_CASE("the extremes of slices without light are theirs, negative ones too") {
  std::vector<Slab> dark = slabs(1, width, height);
  dark[0].values.assign(dark[0].values.size(), -2);
  dark[0].at(2, 1)[3] = -1;
  CHECK(largest(dark)[0][3] == -1);
  CHECK(largest(dark)[0][4] == -2);
  CHECK(minima(dark)[0][3] == -2);
  CHECK(largest_of_all(largest(dark))[0][4] == -1);
}

TEST_CASE("slices are scaled, restored and clipped each on its own") {
  const std::vector<Slab> before = packed(numbered(), width, height);
  std::vector<Slab> now = before;
  PerSlice factor = filled(2, 2);
  factor[1][1] = -0.5F;
  scale(now, factor);
  CHECK(now[0].at(2, 1)[5] == 2 * before[0].at(2, 1)[5]);
  CHECK(now[1].at(0, 1)[1] == -0.5F * before[1].at(0, 1)[1]);
  clip_below(now, 4);
  CHECK(now[0].at(0, 0)[0] == 4);
  CHECK(now[0].at(1, 0)[0] == 4);
  CHECK(now[0].at(2, 0)[0] == 6);
  CHECK(now[1].at(0, 1)[1] == 4);
  PerSlice back = filled(2, 0);
  back[0][5] = back[1][1] = 1;
  restore(now, before, back);
  CHECK(now[0].at(2, 1)[5] == before[0].at(2, 1)[5]);
  CHECK(now[1].at(0, 1)[1] == before[1].at(0, 1)[1]);
  CHECK(now[0].at(2, 1)[6] == 2 * before[0].at(2, 1)[6]);
}

TEST_CASE("the reciprocal of what is not positive is 0") {
  PerSlice values = filled(1, 4);
  values[0][1] = 0;
  values[0][2] = -2;
  values[0][3] = 1e-6F;
  const PerSlice turned = reciprocal(values);
  CHECK(turned[0][0] == 0.25F);
  CHECK(turned[0][1] == 0);
  CHECK(turned[0][2] == 0);
  CHECK(turned[0][3] == 1 / 1e-6F);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Bits of a slice, against the voxels one by one.
#include "verdict/private/bit_slice.hpp"

#include "testing.hpp"

using namespace vam;
using verdict::BitSlice;

namespace {

/// About so many of 64 voxels are of the set.
std::vector<float> random_slice(int width, int height, unsigned of_64, std::mt19937& random) {
  std::vector<float> slice(static_cast<std::size_t>(width * height));
  for (float& value : slice) value = random() % 64 < of_64 ? 1.0F : 0.0F;
  return slice;
}

}  // namespace

TEST_CASE("bits of a slice are its voxels, row by row, and its margin") {
  std::mt19937 random(5);
  for (const int width : {1, 2, 30, 61, 62, 63, 64, 65, 125, 126, 127, 200}) {
    for (const unsigned of_64 : {0U, 1U, 32U, 63U, 64U}) {
      CAPTURE(width);
      CAPTURE(of_64);
      const int height = 4;
      const auto slice = random_slice(width, height, of_64, random);
      const bool margin = random() % 2 != 0;
      const BitSlice bits(width, height, margin, [&](std::size_t pixel) { return slice[pixel] > 0; });
      const auto is = [&](int x, int y) {
        if (x < 0 || y < 0 || x >= width || y >= height) return margin;
        return slice[static_cast<std::size_t>(y * width + x)] > 0;
      };
      bool any = false;
      bool some = true;
      for (int y = -1; y <= height; ++y) {
        for (int x = -1; x <= width; ++x) {
          any = any || (is(x, y) && x >= 0 && x < width && y >= 0 && y < height);
          const int count = std::min(3, width + 1 - x);
          unsigned expected = 0;
          for (int n = 0; n < count; ++n) expected |= (is(x + n, y) ? 1U : 0U) << n;
          some = some && bits.some(x, y, count) == expected;
        }
      }
      CHECK(some);
      CHECK(bits.any() == any);
      for (const bool of : {false, true}) {
        for (const bool with_margin : {false, true}) {
          // Each voxel that is `of` is in one run, and no two runs touch.
          const int edge = with_margin ? 1 : 0;
          std::vector<std::vector<int>> in(static_cast<std::size_t>(height) + 2,
                                           std::vector<int>(static_cast<std::size_t>(width) + 3, 0));
          bool apart = true;
          verdict::VoxelRun last{-2, 0, 0};
          for (const verdict::VoxelRun& run : bits.runs(of, with_margin)) {
            apart = apart && run.begin < run.end && (run.row > last.row || run.begin > last.end);
            last = run;
            for (int x = run.begin; x < run.end; ++x) ++in.at(static_cast<std::size_t>(run.row + 1)).at(x + 1);
          }
          CHECK(apart);
          bool same = true;
          for (int y = -1; y <= height; ++y) {
            for (int x = -1; x <= width; ++x) {
              const bool counts = x >= -edge && x < width + edge && y >= -edge && y < height + edge;
              same = same && in[static_cast<std::size_t>(y + 1)][static_cast<std::size_t>(x + 1)] ==
                                 (counts && is(x, y) == of ? 1 : 0);
            }
          }
          CHECK(same);
        }
      }
    }
  }
}

TEST_CASE("a float reaches a level where it reaches the least float that does") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0.01, 3);
  for (int n = 0; n < 1000; ++n) {
    const double level = any(random);
    const float least = verdict::least_reaching(level);
    CHECK(static_cast<double>(least) >= level);
    CHECK(static_cast<double>(std::nextafter(least, 0.0F)) < level);
  }
  CHECK(verdict::least_reaching(0.5) == 0.5F);
}

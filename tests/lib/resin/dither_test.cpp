// SPDX-License-Identifier: GPL-3.0-or-later
// Error diffusion into grey levels.
#include "resin/dither.hpp"

#include "testing.hpp"

using namespace vam;
using namespace vam::resin;

namespace {

/// A smooth field, 0 outside its middle columns.
Image field(int width, int height) {
  Image image(width, height);
  for (int a = 0; a < height; ++a) {
    for (int c = 4; c < width - 4; ++c) {
      image(c, a) = 0.4F + 0.3F * std::sin(0.11F * static_cast<float>(c)) * std::cos(0.07F * static_cast<float>(a));
    }
  }
  return image;
}

/// RMS of the means over squares of 8 x 8 inside: what is left of the error where a dose adds up many pixels.
double smooth_error(const Image& shown, const Image& wanted) {
  constexpr int square = 8;
  double sum = 0;
  int count = 0;
  for (int a = 0; a + square <= wanted.height; a += square) {
    for (int c = square; c + 2 * square <= wanted.width; c += square, ++count) {
      double mean = 0;
      for (int i = 0; i < square * square; ++i) {
        const int x = c + i % square, y = a + i / square;
        mean += static_cast<double>(shown(x, y) - wanted(x, y)) / (square * square);
      }
      sum += mean * mean;
    }
  }
  return std::sqrt(sum / count);
}

}  // namespace

TEST_CASE("errors cancel over columns and angles, and turns divide them") {
  const Image wanted = field(64, 96);
  const GreyLevels two(Response(), 1);
  const double one_turn = smooth_error(dithered(wanted, Dither(two, 1)), wanted);
  // Rounded alone, a level off by up to a half; diffused, what crosses the border of a square: of 64 pixels some 3.
  CHECK(one_turn < 0.03);
  CHECK(smooth_error(dithered(wanted, Dither(two, 16)), wanted) < one_turn / 8);
}

TEST_CASE("the turns' levels add up to the step, whatever the phase") {
  const GreyLevels levels(Response(0.1), 2);  // with leak
  const Dither dither(levels, 5);
  for (int step = 0; step <= 15; ++step) {
    for (const int phase : {0, 3}) {
      float sum = 0;
      for (int turn = 0; turn < 5; ++turn) sum += levels.intensity(dither.level(step, turn, phase));
      CHECK(sum / 5 == doctest::Approx(dither.intensity(step)));
    }
  }
  CHECK(dither.intensity(15) == 1);
}

TEST_CASE("dark pixels stay dark, and no error is carried beyond full intensity") {
  const GreyLevels levels(Response(), 1);
  const Image shown = dithered(field(64, 32), Dither(levels, 1));
  for (int a = 0; a < 32; ++a) {
    for (const int c : {0, 3, 60, 63}) CHECK(shown(c, a) == 0);
  }
  Image bright(8, 8, 3.0F);
  for (int c = 0; c < 8; ++c) bright(c, 7) = 1e-6F;
  int lit = 0;
  const Image after = dithered(bright, Dither(levels, 1));
  for (int c = 0; c < 8; ++c) lit += after(c, 7) > 0 ? 1 : 0;
  CHECK(lit <= 6);  // half a level from each pixel above, at most
}

TEST_CASE("levels of one intensity count as one") {
  const GreyLevels levels(Response(model::ResponseTable{.grey = {0, 1, 2, 3}, .intensity = {0, 0, 1, 1}}), 2);
  const Dither dither(levels, 1);
  std::vector<float> carried(1, 0.0F);
  std::vector<int> steps(1);
  dither.row(std::vector<float>{1.0F}, false, carried, steps);
  CHECK(dither.intensity(steps[0]) == 1);
  CHECK(levels.intensity(dither.level(steps[0], 0, 0)) == 1);
}

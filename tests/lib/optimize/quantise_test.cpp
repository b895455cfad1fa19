// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/quantise.hpp"

#include <set>

#include "resin/dither.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

Image ramp() {
  Image image(5, 200);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0, 2);
  for (float& v : image.values) v = uniform(random);
  image(0, 0) = 2;
  return image;
}

Image quantised(Image image, int bits, double full_scale, bool feedback) {
  optimize::quantise({&image, 1}, resin::GreyLevels(resin::Response(), bits), full_scale, feedback);
  return image;
}

}  // namespace

TEST_CASE("values become the projector's levels, the nearest ones") {
  const Image image = ramp();
  const Image grey = quantised(image, 2, 2, false);
  const std::set<float> levels(grey.values.begin(), grey.values.end());
  CHECK(levels.size() == 4);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    CHECK(std::abs(image.values[i] - grey.values[i]) <= 2.0F / 3 / 2 + 1e-6F);  // half a step of 2 / (2^2 - 1)
  }
}

TEST_CASE("error feedback rounds as frames of one turn are") {
  Image image = ramp();
  const Image grey = quantised(image, 2, 2, true);
  for (float& value : image.values) value /= 2;
  Image shown = resin::dithered(image, resin::Dither(resin::GreyLevels(resin::Response(), 2), 1));
  for (float& value : shown.values) value *= 2;
  CHECK(grey.values == shown.values);
}

TEST_CASE("a lower full scale clips larger values, none leaves them") {
  const Image grey = quantised(ramp(), 8, 1.0, false);
  for (const float v : grey.values) CHECK(v <= 1.0F);
  CHECK(quantised(ramp(), 8, 0.0, false).values == ramp().values);
}

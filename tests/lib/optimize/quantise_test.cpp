// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/quantise.hpp"

#include <set>

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

Image quantised(const Image& image, int bits, std::optional<double> peak, bool feedback) {
  Image result;
  optimize::Quantiser quantiser(resin::GreyLevels(resin::Response(), bits), peak, feedback,
                                [&](const Image& done) { result = done; });
  quantiser.add(image);
  quantiser.finish();
  return result;
}

}  // namespace

TEST_CASE("values become the projector's levels, the nearest ones") {
  const Image image = ramp();
  const Image grey = quantised(image, 2, std::nullopt, false);
  const std::set<float> levels(grey.values.begin(), grey.values.end());
  CHECK(levels.size() == 4);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    CHECK(std::abs(image.values[i] - grey.values[i]) <= 2.0F / 3 / 2 + 1e-6F);  // half a step of 2 / (2^2 - 1)
  }
}

TEST_CASE("error feedback rounds as frames of one turn are") {
  Image image = ramp();
  const Image grey = quantised(image, 2, std::nullopt, true);
  for (float& value : image.values) value /= 2;
  Image shown = resin::dithered(image, resin::Dither(resin::GreyLevels(resin::Response(), 2), 1));
  for (float& value : shown.values) value *= 2;
  CHECK(grey.values == shown.values);
}

TEST_CASE("a given peak clips larger values") {
  const Image grey = quantised(ramp(), 8, 1.0, false);
  for (const float v : grey.values) CHECK(v <= 1.0F);
  CHECK_THROWS_AS(quantised(ramp(), 8, 0.0, false), Error);
}

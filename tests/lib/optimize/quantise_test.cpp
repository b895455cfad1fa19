#include "optimize/run/quantise.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <set>

#include "base/error.hpp"

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

double column_sum(const Image& image, int column) {
  double sum = 0;
  for (int a = 0; a < image.height; ++a) sum += static_cast<double>(image(column, a));
  return sum;
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

TEST_CASE("error feedback keeps the sum over angles to within one step, whatever the number of angles") {
  const Image image = ramp();
  const Image grey = quantised(image, 2, std::nullopt, true);
  for (int c = 0; c < image.width; ++c) CHECK(std::abs(column_sum(image, c) - column_sum(grey, c)) <= 2.0 / 3);
}

TEST_CASE("a given peak clips what is above it") {
  const Image grey = quantised(ramp(), 8, 1.0, false);
  for (const float v : grey.values) CHECK(v <= 1.0F);
  CHECK_THROWS_AS(quantised(ramp(), 8, 0.0, false), Error);
}

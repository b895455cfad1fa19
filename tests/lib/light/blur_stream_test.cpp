// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/blur/blur_stream.hpp"

#include "light/blur/gaussian_blur.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::light;

namespace {

std::vector<Image> blurred(const std::vector<Image>& in, double sigma_px) {
  std::vector<Image> out;
  BlurStream blur(sigma_px, [&](Image slice) { out.push_back(std::move(slice)); });
  for (const Image& slice : in) blur.push(slice);
  blur.finish();
  return out;
}

std::vector<Image> point(int n, int x, int y, int z) {
  std::vector<Image> volume(static_cast<std::size_t>(n), Image(n, n));
  volume[z](x, y) = 1;
  return volume;
}

}  // namespace

TEST_CASE("the discrete Gaussian has its variance exactly, from a tenth of a pixel to fifty") {
  for (const double sigma : {0.0, 0.1, 0.5, 1.0, 3.0, 20.0, 25.0, 50.0}) {
    const std::vector<double> weights = gaussian_weights(sigma);
    double sum = weights[0];
    double variance = 0;
    for (std::size_t n = 1; n < weights.size(); ++n) {
      sum += 2 * weights[n];
      variance += 2 * weights[n] * static_cast<double>(n * n);
    }
    CHECK(std::abs(sum - 1) < 1e-14);
    CHECK(std::abs(variance - sigma * sigma) <= 1e-5 * sigma * sigma);  // the tail that is cut
  }
}

TEST_CASE("a point becomes a Gaussian, wherever it is") {
  const std::vector<double> w = gaussian_weights(1.3);
  const auto at = [&](int n) {
    const auto i = static_cast<std::size_t>(std::abs(n));
    return i < w.size() ? w[i] : 0.0;
  };
  for (const int z : {0, 4, 16}) {
    const std::vector<Image> out = blurred(point(17, 9, 2, z), 1.3);
    REQUIRE(out.size() == 17);
    for (const auto [k, j, i] : indices(17, 17, 17)) {
      const double want = at(i - 9) * at(j - 2) * at(k - z);
      CHECK(std::abs(out[k](i, j) - want) < 1e-7);  // float rounding
    }
  }
}

TEST_CASE("a narrow volume and a wide kernel: fewer slices than the kernel is high") {
  const std::vector<Image> out = blurred(point(3, 1, 1, 1), 4);
  REQUIRE(out.size() == 3);
  CHECK(out[0](1, 1) == doctest::Approx(out[2](1, 1)).epsilon(1e-6));
  CHECK(blurred(point(3, 1, 1, 1), 0)[1](1, 1) == 1);
  CHECK(blurred({}, 1).empty());
}

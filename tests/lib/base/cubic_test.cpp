// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/cubic.hpp"

#include "testing.hpp"

using namespace vam;

TEST_CASE("the weights of four samples are the kernel's, and give quadratics exactly") {
  for (int i = 0; i <= 20; ++i) {
    const double f = i / 20.0;
    const auto weights = cubic_weights(static_cast<float>(f));
    double sum = 0;
    for (int j = 0; j < 4; ++j) {
      const double at = j - 1;
      CHECK(weights[static_cast<std::size_t>(j)] == doctest::Approx(cubic_kernel(at - f)).epsilon(1e-6));
      sum += weights[static_cast<std::size_t>(j)] * (at * at - 2 * at);
    }
    CHECK(sum == doctest::Approx(f * f - 2 * f).epsilon(1e-6));  // float weights of values up to 3
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Filtered back-projection made non-negative: the start of [CAL17], and the baseline of comparisons.
#include <algorithm>

#include "optimize/methods/method.hpp"

namespace vam::optimize {

namespace {

class Fbp final : public Method {
 public:
  using Method::Method;

  /// g = filter(A f), then negative values set to 0 or raised by the minimum [CAL17 below eq 3, the two ways].
  void start(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    filtered_projections(light, problem.target, iterate.g);
    if (options_.offset) {
      raise_by_minimum(iterate.g);
    } else {
      clip_below(iterate.g, static_cast<float>(options_.min_intensity * light.row_angle_rad()));
    }
    resume(problem, light, iterate);
  }

  void step(const Problem& /*problem*/, const light::Operator& /*light*/, Iterate& /*iterate*/) override {}
  void exchange(Archive& /*archive*/) override {}

 private:
  static void raise_by_minimum(std::vector<Slab>& g) {
    PerSlice lowest = minima(g);
    for_values(g, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) g[s].values[i] -= std::min(0.0F, lowest[s][i % lanes]);
    });
  }
};

}  // namespace

MethodEntry fbp_method() {
  return {.name = "fbp",
          .summary = "Filtered back-projection; negative intensities are set to the lower bound, or offset.",
          .iterations = 0,
          .grey = false,
          .options = {"optimize.min_intensity", "optimize.negative"},
          .make = make<Fbp>};
}

}  // namespace vam::optimize

// SPDX-License-Identifier: GPL-3.0-or-later
// Penalty minimisation [PM21].
#include "optimize/methods/private/descent.hpp"
#include "optimize/methods/private/loss.hpp"

namespace vam::optimize {

namespace {

/// Sum over V of max(0, D - d_l)^p + sum over G of max(0, d_h - D)^p [PM21, the penalty function], weights rho those of
/// the voxels.
class Pm final : public Descent {
 public:
  using Descent::Descent;

 protected:
  [[nodiscard]] float loss(const Problem& problem, std::size_t s, std::size_t i, float dose) const override {
    return power_loss(problem.weight_at(s, i), miss(problem, s, i, dose), options_.power);
  }
  [[nodiscard]] float slope(const Problem& problem, std::size_t s, std::size_t i, float dose) const override {
    return power_slope(problem.weight_at(s, i), miss(problem, s, i, dose), options_.power);
  }

 private:
  static float miss(const Problem& problem, std::size_t s, std::size_t i, float dose) {
    return bounds(problem, problem.demands.window, s, i).miss(dose);
  }
};

}  // namespace

MethodEntry pm_method() {
  return {.name = "pm",
          .summary = "Minimises the penalty on doses on the wrong side of LOW and HIGH, to the power P.",
          .iterations = 60,
          .grey = true,
          .options = {"optimize.power", "--max-intensity"},
          .make = make<Pm>};
}

}  // namespace vam::optimize

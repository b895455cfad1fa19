// SPDX-License-Identifier: GPL-3.0-or-later
// Band-constraint Lp norm [BCLP24].
#include <cmath>

#include "optimize/methods/private/descent.hpp"
#include "optimize/methods/private/loss.hpp"

namespace vam::optimize {

namespace {

/// Sum of w (|M(D) - f| - epsilon)_+^p [BCLP24, the general band-constraint loss], M the response curve, weight w and
/// tolerance epsilon those of the voxel. Within the band there is no penalty. A step has no slope to follow; there D
/// itself is measured from the doses with the right response.
class Bclp final : public Descent {
 public:
  using Descent::Descent;

 protected:
  [[nodiscard]] float loss(const Problem& problem, std::size_t s, std::size_t i, float dose) const override {
    return power_loss(problem.weight_at(s, i), excess(problem, s, i, dose), options_.power);
  }
  [[nodiscard]] float slope(const Problem& problem, std::size_t s, std::size_t i, float dose) const override {
    const float over = excess(problem, s, i, dose);
    if (over == 0) return 0;
    const CureCurve& curve = problem.demands.curve;
    return power_slope(problem.weight_at(s, i), over, options_.power, curve.is_step() ? 1.0F : curve.slope(dose));
  }

 private:
  /// (|M(D) - f| - epsilon)_+, negative where M(D) is below f.
  static float excess(const Problem& problem, std::size_t s, std::size_t i, float dose) {
    if (!is_constrained(problem.labels[s][i])) return 0.0F;
    const CureCurve& curve = problem.demands.curve;
    const float target = problem.target[s].values[i];
    const float tolerance = problem.tolerance_at(s, i);
    if (curve.is_step()) return curve.doses(target, tolerance).miss(dose);
    const float error = curve.response(dose) - target;
    return std::abs(error) <= tolerance ? 0.0F : error - std::copysign(tolerance, error);
  }
};

}  // namespace

MethodEntry bclp_method() {
  return {.name = "bclp",
          .summary = "Minimises the Lp norm of the resin's response outside a band around the target.",
          .iterations = 60,
          .grey = true,
          .options = {"--band", "--resin-response", "optimize.softness", "optimize.power", "--max-intensity"},
          .make = make<Bclp>};
}

}  // namespace vam::optimize

// Penalty minimisation, Bhattacharya et al. 2021 [PM21].
#include <cmath>

#include "optimize/descent.hpp"
#include "optimize/loss.hpp"

namespace vam::optimize {

namespace {

/// Sum over V of max(0, D - d_l)^p + sum over G of max(0, d_h - D)^p [PM21, the penalty function], weights rho equal.
class Pm final : public Descent {
 public:
  using Descent::Descent;

 protected:
  [[nodiscard]] float loss(float dose, float /*target*/, Label label) const override {
    const float d = std::abs(optimize::slope(dose, label, options_.window));
    return d > 0 ? std::pow(d, static_cast<float>(options_.power)) : 0.0F;
  }
  [[nodiscard]] float slope(float dose, float /*target*/, Label label) const override {
    const auto p = static_cast<float>(options_.power);
    const float d = optimize::slope(dose, label, options_.window);
    return d == 0 ? 0.0F : std::copysign(p * std::pow(std::abs(d), p - 1), d);
  }
};

}  // namespace

std::unique_ptr<Method> make_pm(const MethodOptions& options) { return std::make_unique<Pm>(options); }

}  // namespace vam::optimize

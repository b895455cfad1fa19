// Band-constraint Lp norm, Li et al. 2024 [BCLP24].
#include <cmath>

#include "optimize/descent.hpp"

namespace vam::optimize {

namespace {

/// Sum of (|M(D) - f| - epsilon)_+^p [BCLP24, the band-constraint loss], with the logistic response M(D) = 1 / (1 +
/// e^{(T - D)/gamma}) of a resin that cures at the threshold dose T. Within epsilon of the target nothing is asked.
class Bclp final : public Descent {
 public:
  using Descent::Descent;

 protected:
  [[nodiscard]] float loss(float dose, float target, Label label) const override {
    if (label != Label::part && label != Label::void_) return 0.0F;
    const float over = std::abs(response(dose) - target) - static_cast<float>(options_.band);
    return over > 0 ? std::pow(over, static_cast<float>(options_.power)) : 0.0F;
  }
  [[nodiscard]] float slope(float dose, float target, Label label) const override {
    if (label != Label::part && label != Label::void_) return 0.0F;
    const auto p = static_cast<float>(options_.power);
    const float m = response(dose);
    const float over = std::abs(m - target) - static_cast<float>(options_.band);
    if (over <= 0) return 0.0F;
    const float steepness = m * (1.0F - m) / static_cast<float>(options_.softness);  // dM/dD
    return std::copysign(p * std::pow(over, p - 1) * steepness, m - target);
  }

 private:
  [[nodiscard]] float response(float dose) const {
    const auto threshold = static_cast<float>(options_.window.threshold());
    return 1.0F / (1.0F + std::exp((threshold - dose) / static_cast<float>(options_.softness)));
  }
};

}  // namespace

std::unique_ptr<Method> make_bclp(const MethodOptions& options) { return std::make_unique<Bclp>(options); }

}  // namespace vam::optimize

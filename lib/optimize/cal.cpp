// Projected gradient with the resin's threshold inside the loop: computed axial lithography [CAL17 fig 2, CAL19 eq 4].
#include <algorithm>
#include <cmath>

#include "optimize/method.hpp"

namespace vam::optimize {

namespace {

class Cal final : public Method {
 public:
  using Method::Method;

  void start(const Problem& problem, const Operator& light, Iterate& iterate) override {
    Method::start(problem, light, iterate);
    normalise(problem, iterate);
  }

  void resume(const Problem& problem, const Operator& light, Iterate& iterate) override {
    Method::resume(problem, light, iterate);
    normalise(problem, iterate);
  }

  /// x = A* g / max, s = sigmoid((x - d_h) / gamma), g <- max(0, g - lambda filter(A (s - f))) [CAL19 eq 4]. The
  /// threshold of s is the middle of the window. Surface voxels are neither part nor void and ask for nothing.
  void step(const Problem& problem, const Operator& light, Iterate& iterate) override {
    std::vector<Slab>& residual = iterate.dose;
    const auto threshold = static_cast<float>(options_.window.threshold());
    const auto softness = static_cast<float>(options_.softness);
    for_values(residual, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const Label label = problem.labels[s][i];
        const float x = residual[s].values[i];
        const float print = options_.thresholding ? 1.0F / (1.0F + std::exp((threshold - x) / softness)) : x;
        const bool asks = label == Label::part || label == Label::void_;
        residual[s].values[i] = asks ? print - problem.target[s].values[i] : 0.0F;
      }
    });
    if (update_.empty()) update_ = slabs(iterate.g.size(), light.sinogram().width, light.sinogram().height);
    light.forward(residual, update_);
    light.filter(update_);
    const auto step = static_cast<float>(options_.step);
    for_values(iterate.g, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        iterate.g[s].values[i] = std::max(0.0F, iterate.g[s].values[i] - step * update_[s].values[i]);
      }
    });
    light.adjoint(iterate.g, iterate.dose);
    normalise(problem, iterate);
  }

  [[nodiscard]] int usual_iterations() const override { return 30; }

 private:
  /// The largest dose of every slice becomes 1.
  static void normalise(const Problem& problem, Iterate& iterate) {
    const PerSlice factor = reciprocal(maxima(iterate.dose, problem));
    scale(iterate.g, factor);
    scale(iterate.dose, factor);
  }

  std::vector<Slab> update_;
};

}  // namespace

std::unique_ptr<Method> make_cal(const MethodOptions& options) { return std::make_unique<Cal>(options); }

}  // namespace vam::optimize

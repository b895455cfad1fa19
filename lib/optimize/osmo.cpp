// Object-space model optimisation, Rackson et al. 2021 [OSMO21].
#include <algorithm>

#include "optimize/method.hpp"

namespace vam::optimize {

namespace {

class Osmo final : public Method {
 public:
  using Method::Method;

  /// The model m starts as the ramp-filtered target: A m is then about filter(A f), as filter is about (A A*)^-1.
  void start(const Problem& problem, const Operator& light, Iterate& iterate) override {
    filtered_projections(light, problem.target, iterate.g);
    light.filter(iterate.g);
    begin(problem, light, iterate);
    project(problem, light, iterate);
  }

  /// Given projections g stand for the model with A m = g.
  void resume(const Problem& problem, const Operator& light, Iterate& iterate) override {
    light.filter(iterate.g);
    begin(problem, light, iterate);
    project(problem, light, iterate);
  }

  /// m_V -= max(0, x - d_l), then m_G += max(0, d_h - x), each followed by g = max(0, A m / max), x = A* g / max
  /// [OSMO21, the two steps of the algorithm]. Doses are relative to the largest.
  void step(const Problem& problem, const Operator& light, Iterate& iterate) override {
    const auto low = static_cast<float>(options_.window.low);
    const auto high = static_cast<float>(options_.window.high);
    for (const Label half : {Label::void_, Label::part}) {
      for_values(model_, [&](std::size_t s, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          if (problem.labels[s][i] != half) continue;
          const float x = iterate.dose[s].values[i];
          model_[s].values[i] += half == Label::void_ ? -std::max(0.0F, x - low) : std::max(0.0F, high - x);
        }
      });
      project(problem, light, iterate);
    }
  }

  [[nodiscard]] int usual_iterations() const override { return 30; }

 private:
  /// model = A* of what is in g, its largest value 1.
  void begin(const Problem& problem, const Operator& light, Iterate& iterate) {
    model_ = slabs(iterate.g.size(), light.object().width, light.object().height);
    light.adjoint(iterate.g, model_);
    for_values(model_, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        if (problem.labels[s][i] == Label::outside) model_[s].values[i] = 0.0F;
      }
    });
    scale(model_, reciprocal(maxima(model_, problem)));
  }

  void project(const Problem& problem, const Operator& light, Iterate& iterate) {
    light.forward(model_, iterate.g);
    clip_below(iterate.g, 0.0F);
    if (iterate.dose.empty()) iterate.dose = slabs(iterate.g.size(), light.object().width, light.object().height);
    light.adjoint(iterate.g, iterate.dose);
    const PerSlice unit = reciprocal(maxima(iterate.dose, problem));
    scale(iterate.g, unit);
    scale(iterate.dose, unit);
  }

  std::vector<Slab> model_;
};

}  // namespace

std::unique_ptr<Method> make_osmo(const MethodOptions& options) { return std::make_unique<Osmo>(options); }

}  // namespace vam::optimize

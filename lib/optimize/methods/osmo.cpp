// SPDX-License-Identifier: GPL-3.0-or-later
// Object-space model optimisation [OSMO21].
#include <algorithm>
#include <limits>

#include "optimize/methods/method.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/methods/private/loss.hpp"
#include "optimize/methods/private/safeguard.hpp"

namespace vam::optimize {

namespace {

class Osmo final : public Method {
 public:
  using Method::Method;

  /// The model m starts as the ramp-filtered target: A m is then about filter(A f), as filter is about (A A*)^-1.
  void start(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    filtered_projections(light, problem.target, iterate.g);
    light.filter(iterate.g);
    begin(problem, light, iterate);
    project(problem, light, iterate);
  }

  /// Given projections g stand for the model with A m = g.
  void resume(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    light.filter(iterate.g);
    begin(problem, light, iterate);
    project(problem, light, iterate);
  }

  /// m_V -= w max(0, x - d_l), then m_G += w max(0, d_h - x), each followed by g = max(0, A m / max), x = A* g / max
  /// [OSMO21, the two steps of the algorithm, weights w 1 there]. Doses are relative to the largest.
  void step(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    for (const Label half : {Label::void_, Label::part}) {
      for_values(model_, [&](std::size_t s, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
          if (problem.labels[s][i] != half) continue;
          model_[s].values[i] -= slope(problem, problem.demands.window, s, i, iterate.dose[s].values[i]);
        }
      });
      project(problem, light, iterate);
    }
  }

  void exchange(Archive& archive) override {
    archive(model_);
    archive(unit_);
  }

 private:
  /// model = A* of what is in g, its largest value 1.
  void begin(const Problem& problem, const light::Operator& light, Iterate& iterate) {
    model_ = slabs(iterate.g.size(), light.object().width, light.object().height);
    light.adjoint(iterate.g, model_);
    for_values(model_, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        if (problem.labels[s][i] == Label::outside) model_[s].values[i] = 0.0F;
      }
    });
    scale(model_, reciprocal(largest_pooled(maxima(model_, problem), light)));
  }

  void project(const Problem& problem, const light::Operator& light, Iterate& iterate) {
    light.forward(model_, iterate.g);
    bound(iterate.g, largest_light(options_, light));
    if (iterate.dose.empty()) iterate.dose = slabs(iterate.g.size(), light.object().width, light.object().height);
    light.adjoint(iterate.g, iterate.dose);
    const PerSlice now = reciprocal(largest_pooled(maxima(iterate.dose, problem), light));
    unit_ = unit_.empty() || options_.max_intensity <= 0 ? now : smaller(unit_, now);
    scale(iterate.g, unit_);
    scale(iterate.dose, unit_);
  }

  /// The scale of limited light never grows: with that of clipped light the limit would fall, and clip more.
  static PerSlice smaller(PerSlice a, const PerSlice& b) {
    for_slices(a, [&](std::size_t s, std::size_t lane) { a[s][lane] = std::min(a[s][lane], b[s][lane]); });
    return a;
  }

  /// 0 <= g <= g_max. The scale that g will have is not known yet; the last one is near.
  void bound(std::vector<Slab>& g, float peak) const {
    for_values(g, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const float unit = unit_.empty() ? 0.0F : unit_[s][i % lanes];
        const float most = unit > 0 ? peak / unit : std::numeric_limits<float>::max();
        g[s].values[i] = std::clamp(g[s].values[i], 0.0F, most);
      }
    });
  }

  PerSlice unit_;  // what the last projections were scaled by
  std::vector<Slab> model_;
};

}  // namespace

MethodEntry osmo_method() {
  return {.name = "osmo",
          .summary = "Corrects a model of the part by the errors of the dose, in void and part alternately.",
          .iterations = 30,
          .grey = false,
          .options = {"--max-intensity"},
          .make = make<Osmo>};
}

}  // namespace vam::optimize

// SPDX-License-Identifier: GPL-3.0-or-later
// Projected gradient with the resin's threshold inside the loop: computed axial lithography [CAL17 fig 2, CAL19 eq 4].
#include <algorithm>

#include "optimize/methods/method.hpp"
#include "optimize/methods/private/safeguard.hpp"
#include "optimize/methods/private/two_metric.hpp"

namespace vam::optimize {

namespace {

constexpr float cal_shorter = 0.5F;
constexpr float longer = 1.1F;

/// The doses of narrow gaps lie near the threshold, and a softer resin takes them for half cured. With 0.02, resolution
/// charts have a wider window still, but gyroids a narrower one.
constexpr double softness = 0.03;

class Cal final : public Method {
 public:
  using Method::Method;

  void start(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    Method::start(problem, light, iterate);
    start_at_threshold(problem, light, iterate);
    prepare(problem, light, iterate);
  }

  void resume(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    Method::resume(problem, light, iterate);
    prepare(problem, light, iterate);
  }

  /// x = A* g, s = M(x), g <- max(0, g - lambda P A w (s - f)) [CAL19 eq 4], P the preconditioner and s - f the slope
  /// of the loss of losses(). lambda is found by line search: longer while that loss falls, else back and shorter.
  void step(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    if (update_.empty()) {
      update_ = iterate.g;
      before_ = iterate;
    }
    for_values(iterate.dose, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const float print = problem.demands.curve.response(iterate.dose[s].values[i]);
        const bool constrained = is_constrained(problem.labels[s][i]);
        before_.dose[s].values[i] =
            constrained ? problem.weight_at(s, i) * (print - problem.target[s].values[i]) : 0.0F;
      }
    });
    light.forward(before_.dose, update_);
    const float peak = largest_light(options_, light);
    bounds_.fix_active_bounds(update_, peak, [&](std::size_t s, std::size_t i) { return iterate.g[s].values[i]; });
    light.precondition(update_);
    for_values(iterate.g, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        float& now = iterate.g[s].values[i];
        before_.g[s].values[i] = now;
        now = bounds_.step(s, i, now, length_[s][i % lanes] * update_[s].values[i], peak);
      }
    });
    std::swap(iterate.dose, before_.dose);
    light.adjoint(iterate.g, iterate.dose);
    const PerSlice back = go_back(iterate, before_, loss_, losses(problem, light, iterate));
    for_slices(back, [&](std::size_t s, std::size_t lane) {
      length_[s][lane] *= back[s][lane] != 0.0F ? cal_shorter : longer;
    });
  }

  void exchange(Archive& archive) override {
    archive(length_);
    archive(loss_);
  }

  [[nodiscard]] bool keeps_scale() const override { return true; }

 private:
  /// The line search begins with Newton's step for a resin whose response is the dose: P is about (A A*)^-1.
  void prepare(const Problem& problem, const light::Operator& light, Iterate& iterate) {
    enter_bounds(problem, light, largest_light(options_, light), iterate);
    length_ = filled(iterate.g.size(), 1.0F);
    loss_ = losses(problem, light, iterate);
  }

  /// Sum of w (integral of M up to x - f x).
  static PerSlice losses(const Problem& problem, const light::Operator& light, const Iterate& iterate) {
    return pooled(summed(iterate.dose,
                         [&](std::size_t s, std::size_t i) {
                           if (!is_constrained(problem.labels[s][i])) return 0.0F;
                           const float x = iterate.dose[s].values[i];
                           const float f = problem.target[s].values[i];
                           return problem.weight_at(s, i) * (problem.demands.curve.area(x) - f * x);
                         }),
                  light);
  }

  Iterate before_;
  std::vector<Slab> update_;
  PerSlice length_, loss_;
  TwoMetric bounds_;
};

}  // namespace

MethodEntry cal_method() {
  return {"cal",
          "Projected gradient descent on the error of the print, with the gelation threshold in the loop.",
          30,
          false,
          {"--resin-response", "optimize.softness", "--max-intensity"},
          make<Cal>,
          nullptr,
          softness};
}

}  // namespace vam::optimize

// SPDX-License-Identifier: GPL-3.0-or-later
// The widest process window itself, instead of a sum of losses: no voxel is nearer to the threshold than need be.
#include <algorithm>
#include <optional>
#include <utility>

#include "optimize/methods/method.hpp"
#include "optimize/methods/private/safeguard.hpp"
#include "optimize/methods/saddle.hpp"
#include "optimize/methods/step_length.hpp"

namespace vam::optimize {

namespace {

/// 1 for part, -1 for void, 0 for voxels that are free.
std::vector<Slab> signs(const Problem& problem) {
  std::vector<Slab> sign = slabs(problem.target.size(), problem.target[0].width, problem.target[0].height);
  for_values(sign, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Label label = problem.labels[s][i];
      if (!is_constrained(label) || problem.weight_at(s, i) == 0) continue;
      sign[s].values[i] = label == Label::part ? 1.0F : -1.0F;
    }
  });
  return sign;
}

/// The light of the saddle's last step within its bounds, and its dose. Slices share one margin.
class Minimax final : public Method {
 public:
  using Method::Method;

  void start(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    Method::start(problem, light, iterate);
    start_at_threshold(problem, light, iterate);
    enter_bounds(problem, light, largest_light(options_, light), iterate);
    begin(problem, light, iterate);
  }

  void resume(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    Method::resume(problem, light, iterate);
    begin(problem, light, iterate);
  }

  void step(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    if (!saddle_) make_saddle(problem, light);  // the first step after an interruption
    const Saddle::Aim aim{problem.demands.window.threshold(), largest_light(options_, light)};
    saddle_->step(state_, aim);
    const std::vector<Slab>& g = saddle_->point().light;
    for_values(iterate.g, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        iterate.g[s].values[i] = std::clamp(g[s].values[i], 0.0F, aim.peak);
      }
    });
    find_dose(problem, light, iterate);
    if (options_.max_intensity <= 0) return;
    const double margin = saddle_->largest_margin(aim);
    margin_ = aim.peak == peak_ ? std::min(margin_, margin) : margin;
    peak_ = aim.peak;
    threshold_ = aim.threshold;
  }

  void exchange(Archive& archive) override {
    state_.exchange(archive);
    archive(eigenvalue_);
    archive(margin_);
    archive(threshold_);
    archive(peak_);
  }

  [[nodiscard]] bool keeps_scale() const override { return true; }
  [[nodiscard]] double provable_ratio() const override {
    return peak_ > 0 && margin_ < threshold_ ? (threshold_ - margin_) / (threshold_ + margin_) : 0;
  }

 private:
  void begin(const Problem& problem, const light::Operator& light, const Iterate& iterate) {
    eigenvalue_ = largest_eigenvalue(light, problem);
    make_saddle(problem, light);
    state_ = saddle_->begin(iterate.g);
  }

  void make_saddle(const Problem& problem, const light::Operator& light) {
    saddle_.emplace(light, signs(problem), eigenvalue_);
  }

  double eigenvalue_ = 0;  // the largest one of P A A*
  std::optional<Saddle> saddle_;
  SaddleState state_;
  // The largest margin that light of this peak can have, by the best proof so far; peak 0: no proof.
  double margin_ = 0, threshold_ = 0;
  float peak_ = 0;
};

}  // namespace

MethodEntry minimax_method() {
  return {"minimax",
          "Widens the process window itself, in some hundreds of iterations (--patience 0): well beyond apg where the "
          "maximum intensity is low or the part is hard to print.",
          200,
          false,
          {"--max-intensity"},
          make<Minimax>,
          nullptr,
          usual_softness,
          5,
          6};
}

}  // namespace vam::optimize

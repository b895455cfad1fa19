// SPDX-License-Identifier: GPL-3.0-or-later
// Background and dose normalisation [OST22 Methods, OST22 fig S6].
#include <algorithm>

#include "optimize/methods/method.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/methods/private/safeguard.hpp"

namespace vam::optimize {

namespace {

// Dose below this fraction of I_0 is taken as this fraction: a void that receives no light at all would otherwise need
// an infinite correction.
constexpr float least_ratio = 0.05F;

class DoseNorm final : public Method {
 public:
  using Method::Method;

  /// I_0 = max(f, B) inside the writable circle; S_0 = filter(A I_0), floored; D_0 = A* S_0.
  void start(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    object_ = problem.target;
    for_values(object_, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) object_[s].values[i] = goal(problem, s, i);
    });
    goal_sums_ = pooled(sums(object_, problem), light);
    project(problem, light, iterate);
  }

  void resume(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    std::vector<Slab> given = std::move(iterate.g);
    start(problem, light, iterate);
    iterate.g = std::move(given);
    light.adjoint(iterate.g, iterate.dose);
  }

  /// D scaled to the mean of I_0; N = D / I_0; I_{k+1} = I_k / N. One step is the paper's I_1 = I_0 / N_0; repeated,
  /// the correction accumulates, so that it settles where D is proportional to I_0.
  void step(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    const PerSlice dose_sums = pooled(sums(iterate.dose, problem), light);
    for_values(object_, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const float sum = dose_sums[s][i % lanes];
        const float wanted = goal(problem, s, i);
        if (sum <= 0 || wanted <= 0) continue;
        const float ratio = iterate.dose[s].values[i] * (goal_sums_[s][i % lanes] / sum) / wanted;
        object_[s].values[i] /= std::max(ratio, least_ratio);
      }
    });
    project(problem, light, iterate);
  }

  void exchange(Archive& archive) override {
    archive(object_);
    archive(goal_sums_);
  }

 private:
  /// I_0 = max(f, B).
  [[nodiscard]] float goal(const Problem& problem, std::size_t s, std::size_t i) const {
    const float target = problem.target[s].values[i];
    return problem.labels[s][i] == Label::outside ? target : std::max(target, static_cast<float>(options_.void_dose));
  }

  void project(const Problem& problem, const light::Operator& light, Iterate& iterate) {
    filtered_projections(light, object_, iterate.g);
    clip_below(iterate.g, static_cast<float>(options_.min_intensity * light.row_angle_rad()));
    find_dose(problem, light, iterate);
  }

  std::vector<Slab> object_;  // I_k
  PerSlice goal_sums_;
};

}  // namespace

MethodEntry dose_norm_method() {
  return {"dose-norm",
          "Filtered back-projection with a background dose in the void, divided once by the resulting dose: fast, with "
          "a small process window.",
          1,
          false,
          {"optimize.void_dose", "optimize.min_intensity"},
          make<DoseNorm>};
}

}  // namespace vam::optimize

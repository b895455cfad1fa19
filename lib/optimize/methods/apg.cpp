// SPDX-License-Identifier: GPL-3.0-or-later
// Accelerated projected gradient: FISTA [BT09] on the one-sided quadratic loss, with the ramp filter as preconditioner
// and restarts [OC15], from the better of two quick answers. Multipliers [NW06] carry the loss, a sum, towards the
// widest window, which the extreme voxels decide.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "optimize/methods/method.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/methods/private/loss.hpp"
#include "optimize/methods/private/robust.hpp"
#include "optimize/methods/private/safeguard.hpp"
#include "optimize/methods/private/surface_points.hpp"
#include "optimize/methods/private/two_metric.hpp"
#include "optimize/methods/step_length.hpp"

namespace vam::optimize {

namespace {

constexpr float momentum = 4;  // at the start, which is near the end: saves two iterations of ten

constexpr float shorter = 0.7F;  // measured on a 512 x 512 resolution target; 0.5 and 0.9 do a little worse

constexpr float ambition = 1.3F;  // of the window asked for, where it prints, and of that which is reached
constexpr float widest = 0.3F;    // half width, in doses
constexpr float missing = 0.01F;  // of the part's voxels, that may miss the window by all of its half width
constexpr float multiplier_rate = 0.5F;

constexpr float close_enough = 0.2F;  // of the band of a grey voxel
constexpr float narrower = 0.9F;
constexpr float narrowest = 0.1F;

class Apg final : public Method {
 public:
  using Method::Method;

  void start(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    Method::start(problem, light, iterate);
    start_at_threshold(problem, light, iterate);
    if (!problem.demands.grey) start_from_better(problem, light, iterate);
    prepare(problem, light, iterate);
  }

  void resume(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    Method::resume(problem, light, iterate);
    prepare(problem, light, iterate);
  }

  /// y = g_k + beta (g_k - g_{k-1}); g_{k+1} = max(0, y - s P A r(A* y)), where P is the floored ramp, r the slope of
  /// the loss, and A* y comes free from the doses of g_k and g_{k-1}.
  void step(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    if (update_.empty()) update_ = iterate.g;
    if (!surface_) surface_.emplace(problem);  // the first step after an interruption
    const float peak = largest_light(options_, light);
    const PerSlice beta = advance();
    residual(problem, iterate, beta);
    light.forward(before_.dose, update_);
    const auto ahead = [&](std::size_t s, std::size_t i) {
      const float now = iterate.g[s].values[i];
      return now + beta[s][i % lanes] * (now - before_.g[s].values[i]);
    };
    bounds_.fix_active_bounds(update_, peak, ahead);
    light.precondition(update_);
    for_values(iterate.g, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const float y = ahead(s, i);
        before_.g[s].values[i] = iterate.g[s].values[i];
        iterate.g[s].values[i] = bounds_.step(s, i, y, length_[s][i % lanes] * update_[s].values[i], peak);
      }
    });
    std::swap(iterate.dose, before_.dose);
    find_dose(problem, light, iterate);
    safeguard(problem, light, iterate);
  }

  void exchange(Archive& archive) override {
    archive(before_.g);
    archive(before_.dose);
    archive(momentum_);
    archive(length_);
    archive(multipliers_);
    archive(loss_);
    archive(allowed_);
    archive(half_width_);
  }

  [[nodiscard]] bool keeps_scale() const override { return true; }
  [[nodiscard]] std::optional<SurfaceMiss> surface_miss(std::span<const Slab> dose) const override {
    if (!surface_ || surface_->points().empty()) return std::nullopt;
    return surface_->miss(dose);
  }

 private:
  /// Slices that dose normalisation prints better than filtered back-projection start from it.
  void start_from_better(const Problem& problem, const light::Operator& light, Iterate& iterate) {
    before_ = {};
    const auto normalisation = make_method("dose-norm", {});
    normalisation->start(problem, light, before_);
    normalisation->step(problem, light, before_);
    start_at_threshold(problem, light, before_);
    const auto plain = metrics(iterate.dose, problem);
    const auto normalised = metrics(before_.dose, problem);
    PerSlice better = filled(iterate.g.size(), 0.0F);
    for (std::size_t k = 0; k < plain.size(); ++k) {
      better[k / lanes][k % lanes] = static_cast<float>(merit(normalised[k]) - merit(plain[k]));
    }
    better = pooled(std::move(better), light);
    for (auto& lane : better) {
      for (float& gain : lane) gain = std::max(gain, 0.0F);
    }
    restore(iterate.g, before_.g, better);
    restore(iterate.dose, before_.dose, better);
  }

  void prepare(const Problem& problem, const light::Operator& light, Iterate& iterate) {
    enter_bounds(problem, light, largest_light(options_, light), iterate);
    before_ = iterate;
    const DoseWindow& window = problem.demands.window;
    const bool grey = problem.demands.grey;
    const double half_width = grey ? static_cast<double>(aimed_share) : 0.5 * (window.high - window.low);
    length_ = filled(iterate.g.size(), static_cast<float>(1.0 / largest_eigenvalue(light, problem)));
    momentum_ = filled(iterate.g.size(), momentum);
    half_width_ = filled(iterate.g.size(), static_cast<float>(half_width));
    surface_.emplace(problem);
    allowed_ = pooled(
        summed(iterate.dose,
               [&](std::size_t s, std::size_t i) { return problem.labels[s][i] == Label::part ? missing : 0.0F; }),
        light);
    multipliers_.clear();
    ask_more(problem, light, iterate);
  }

  /// t_{k+1} = (1 + sqrt(1 + 4 t_k^2)) / 2, beta = (t_k - 1) / t_{k+1}.
  PerSlice advance() {
    PerSlice beta(momentum_.size());
    for_slices(beta, [&](std::size_t s, std::size_t lane) {
      const float t = momentum_[s][lane];
      momentum_[s][lane] = 0.5F * (1.0F + std::sqrt(1.0F + 4.0F * t * t));
      beta[s][lane] = (t - 1.0F) / momentum_[s][lane];
    });
    return beta;
  }

  /// The slopes at y, in the place of the dose before.
  void residual(const Problem& problem, const Iterate& iterate, const PerSlice& beta) {
    for_values(iterate.dose, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const float now = iterate.dose[s].values[i];
        float& before = before_.dose[s].values[i];
        before = now + beta[s][i % lanes] * (now - before);
      }
    });
    const std::vector<float> misses = surface_->misses(before_.dose);
    for_values(iterate.dose, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        float& ahead = before_.dose[s].values[i];
        ahead = problem.weight_at(s, i) * miss(problem, s, i, ahead);
      }
    });
    surface_->add_slopes(misses, before_.dose);
  }

  /// A slice whose loss went up continues with a shorter step, without momentum.
  void safeguard(const Problem& problem, const light::Operator& light, Iterate& iterate) {
    const PerSlice back = go_back(iterate, before_, loss_, losses(problem, light, iterate));
    for_slices(back, [&](std::size_t s, std::size_t lane) {
      if (back[s][lane] == 0.0F) return;
      momentum_[s][lane] = 1.0F;
      length_[s][lane] *= shorter;
    });
    ask_more(problem, light, iterate);
  }

  /// Distance of a dose from the doses allowed, moved by the multipliers.
  [[nodiscard]] float miss(const Problem& problem, std::size_t s, std::size_t i, float dose) const {
    DoseRange allowed = bounds(problem, window(problem, s, i % lanes), s, i, half_width_[s][i % lanes]);
    if (!multipliers_.empty()) {
      allowed.low += multipliers_[s].values[i];
      allowed.high -= multipliers_[s].values[i];
    }
    return allowed.miss(dose);
  }

  /// The losses of the voxels.
  [[nodiscard]] PerSlice voxel_losses(const Problem& problem, const light::Operator& light,
                                      const Iterate& iterate) const {
    return pooled(summed(iterate.dose,
                         [&](std::size_t s, std::size_t i) {
                           const float by = miss(problem, s, i, iterate.dose[s].values[i]);
                           return 0.5F * problem.weight_at(s, i) * by * by;
                         }),
                  light);
  }

  /// With the surface's.
  [[nodiscard]] PerSlice losses(const Problem& problem, const light::Operator& light, const Iterate& iterate) const {
    PerSlice sum = voxel_losses(problem, light, iterate);
    const PerSlice surface = pooled(surface_->losses(surface_->misses(iterate.dose), sum.size()), light);
    for_slices(sum, [&](std::size_t s, std::size_t lane) { sum[s][lane] += surface[s][lane]; });
    return sum;
  }

  [[nodiscard]] DoseWindow window(const Problem& problem, std::size_t s, std::size_t lane) const {
    const double middle = problem.demands.window.threshold();
    const auto half = static_cast<double>(half_width_[s][lane]);
    return {middle - half, middle + half};
  }

  /// What the next step is asked for.
  void ask_more(const Problem& problem, const light::Operator& light, const Iterate& iterate) {
    if (problem.demands.grey) {
      narrow(problem, light, iterate);
    } else {
      const PerSlice wrong = largest_wrong(problem, light, iterate.dose);
      widen(problem, light, iterate.dose, wrong);
      multiply(problem, iterate.dose, wrong);
    }
    loss_ = losses(problem, light, iterate);
  }

  /// By how much a dose is beyond the threshold on the wrong side; negative: it is on the right one.
  static float wrong_by(const Problem& problem, std::size_t s, std::size_t i, float dose) {
    const float above = dose - static_cast<float>(problem.demands.window.threshold());
    return problem.labels[s][i] == Label::part ? -above : above;
  }

  /// The largest of a slice; negative: it prints.
  [[nodiscard]] static PerSlice largest_wrong(const Problem& problem, const light::Operator& light,
                                              std::span<const Slab> dose) {
    return largest_pooled(reduce(
                              dose, -1.0F,
                              [&](float& a, std::size_t s, std::size_t i) {
                                if (is_constrained(problem.labels[s][i]))
                                  a = std::max(a, wrong_by(problem, s, i, dose[s].values[i]));
                              },
                              larger),
                          light);
  }

  /// The window of a slice, about the threshold, is as wide as leaves the misses that are allowed: easy parts reach the
  /// widest one they can, and hard ones are not given thresholds they cannot reach. A step of Newton's method; the sum
  /// of misses is convex in the half width.
  void widen(const Problem& problem, const light::Operator& light, std::span<const Slab> dose, const PerSlice& wrong) {
    constexpr float most = 1.3F;
    const auto asked = static_cast<float>(0.5 * (problem.demands.window.high - problem.demands.window.low));
    const auto by = [&](std::size_t s, std::size_t i) {
      return std::abs(bounds(problem, window(problem, s, i % lanes), s, i).miss(dose[s].values[i]));
    };
    const PerSlice sum = pooled(summed(dose, by), light);
    const PerSlice count =
        pooled(summed(dose, [&](std::size_t s, std::size_t i) { return by(s, i) > 0 ? 1.0F : 0.0F; }), light);
    for_slices(half_width_, [&](std::size_t s, std::size_t lane) {
      float& half = half_width_[s][lane];
      const float more = count[s][lane] - allowed_[s][lane];
      const float next = more > 0 ? half - (sum[s][lane] - allowed_[s][lane] * half) / more : most * half;
      const float least = wrong[s][lane] < 0 ? ambition * asked : asked;
      half = std::clamp(next, least, std::max(least, widest));
    });
  }

  /// Voxels of a slice that prints count for more where they are within `ambition` of the window that it reaches, else
  /// for less: the method of multipliers. Of thresholds out of reach, and of a slice that cannot print, they would grow
  /// without end and take the surface out of its place.
  void multiply(const Problem& problem, std::span<const Slab> dose, const PerSlice& wrong) {
    if (multipliers_.empty()) multipliers_ = slabs(dose.size(), dose[0].width, dose[0].height);
    fill(multipliers_, [&](std::size_t s, std::size_t i) {
      const float now = multipliers_[s].values[i];
      if (!is_constrained(problem.labels[s][i]) || wrong[s][i % lanes] >= 0) return now;
      const float half = std::min(half_width_[s][i % lanes], -ambition * wrong[s][i % lanes]);
      return std::max(0.0F, now + multiplier_rate * (wrong_by(problem, s, i, dose[s].values[i]) + half));
    });
  }

  /// A grey slice that is nearly within its bands is given narrower ones, so that doses do not stay at their edges.
  void narrow(const Problem& problem, const light::Operator& light, const Iterate& iterate) {
    const PerSlice losses_now = voxel_losses(problem, light, iterate);
    for_slices(half_width_, [&](std::size_t s, std::size_t lane) {
      float& share = half_width_[s][lane];
      // One voxel that misses by a fifth of the share costs so much.
      const float close = close_enough * share * static_cast<float>(problem.demands.band);
      if (losses_now[s][lane] <= 0.5F * close * close) share = std::max(narrowest, narrower * share);
    });
  }

  Iterate before_;
  std::vector<Slab> update_;
  PerSlice momentum_, length_, loss_;
  std::optional<SurfacePoints> surface_;
  PerSlice half_width_;            // of each slice's window about the threshold; of a grey one the share of its band
  PerSlice allowed_;               // sum of the misses of a slice, in half widths
  std::vector<Slab> multipliers_;  // doses by which thresholds are moved; empty: not yet
  TwoMetric bounds_;
};

}  // namespace

MethodEntry apg_method() {
  return {"apg",
          "Accelerated projected gradient: the void below LOW, the part above HIGH, the surface at the threshold; "
          "then it widens the window as far as hardly any voxel misses it.",
          60,
          true,
          {"--max-intensity", "--robust", "optimize.surface", "--delivered"},
          make<Apg>,
          make_robust,
          usual_softness,
          1};
}

}  // namespace vam::optimize

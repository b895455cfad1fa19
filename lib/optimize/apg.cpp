// Accelerated projected gradient: FISTA (Beck & Teboulle 2009) on the one-sided quadratic loss, with the ramp filter as
// preconditioner and restarts (O'Donoghue & Candes 2015).
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "optimize/loss.hpp"
#include "optimize/method.hpp"
#include "optimize/safeguard.hpp"
#include "optimize/step_length.hpp"

namespace vam::optimize {

namespace {

constexpr float shorter = 0.7F;  // measured on a 512 x 512 resolution target; 0.5 and 0.9 do a little worse

constexpr float close_enough = 0.2F;  // of the half width of a slice's window
constexpr float wider = 1.1F;
constexpr float widest = 0.3F;  // half width, in doses

class Apg final : public Method {
 public:
  using Method::Method;

  void start(const Problem& problem, const Operator& light, Iterate& iterate) override {
    Method::start(problem, light, iterate);
    start_at_threshold(problem, light, iterate);
    prepare(problem, light, iterate);
  }

  void resume(const Problem& problem, const Operator& light, Iterate& iterate) override {
    Method::resume(problem, light, iterate);
    prepare(problem, light, iterate);
  }

  /// y = g_k + beta (g_k - g_{k-1}); g_{k+1} = max(0, y - s P A r(A* y)), where P is the floored ramp, r the slope of
  /// the loss, and A* y comes free from the doses of g_k and g_{k-1}.
  void step(const Problem& problem, const Operator& light, Iterate& iterate) override {
    if (update_.empty()) update_ = iterate.g;
    const float peak = largest_light(options_, light);
    const PerSlice beta = advance();
    residual(problem, iterate, beta);
    light.forward(before_.dose, update_);
    hold_active(iterate, beta, peak);
    light.precondition(update_);
    for_values(iterate.g, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const float now = iterate.g[s].values[i];
        const float ahead = now + beta[s][i % lanes] * (now - before_.g[s].values[i]);
        before_.g[s].values[i] = now;
        const float next = std::clamp(ahead - length_[s][i % lanes] * update_[s].values[i], 0.0F, peak);
        iterate.g[s].values[i] = active(s, i) ? std::clamp(ahead, 0.0F, peak) : next;
      }
    });
    std::swap(iterate.dose, before_.dose);
    light.adjoint(iterate.g, iterate.dose);
    safeguard(problem, light, iterate);
  }

  void exchange(Archive& archive) override {
    archive(before_.g);
    archive(before_.dose);
    archive(momentum_);
    archive(length_);
    archive(loss_);
    archive(half_width_);
  }

  [[nodiscard]] bool keeps_scale() const override { return true; }
  [[nodiscard]] bool takes_grey() const override { return true; }
  [[nodiscard]] int usual_iterations() const override { return 60; }

 private:
  void prepare(const Problem& problem, const Operator& light, const Iterate& iterate) {
    before_ = iterate;
    const Window& window = problem.demands.window;
    length_ = constant(iterate.g.size(), static_cast<float>(1.0 / largest_eigenvalue(light, problem)));
    momentum_ = constant(iterate.g.size(), 1.0F);
    half_width_ = constant(iterate.g.size(), static_cast<float>(0.5 * (window.high - window.low)));
    loss_ = losses(problem, light, iterate);
  }

  /// Values at a bound that the plain gradient would push beyond it are held there, and only the others take part in
  /// the preconditioned step: clipping a step along P would not go downhill (two-metric projection, Bertsekas 1982).
  void hold_active(const Iterate& iterate, const PerSlice& beta, float peak) {
    active_.resize(iterate.g.size(), std::vector<std::uint16_t>(iterate.g[0].values.size() / lanes));
    for_values(iterate.g, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; i += lanes) {
        unsigned bits = 0;
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const float now = iterate.g[s].values[i + lane];
          const float ahead = now + beta[s][lane] * (now - before_.g[s].values[i + lane]);
          float& u = update_[s].values[i + lane];
          const bool held = (ahead <= 0 && u > 0) || (ahead >= peak && u < 0);
          bits |= held ? 1U << lane : 0U;
          u = held ? 0.0F : u;
        }
        active_[s][i / lanes] = static_cast<std::uint16_t>(bits);
      }
    });
  }

  [[nodiscard]] bool active(std::size_t s, std::size_t i) const {
    return ((active_[s][i / lanes] >> (i % lanes)) & 1U) != 0;
  }

  /// t_{k+1} = (1 + sqrt(1 + 4 t_k^2)) / 2, beta = (t_k - 1) / t_{k+1}.
  PerSlice advance() {
    PerSlice beta(momentum_.size());
    for (std::size_t s = 0; s < beta.size(); ++s) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const float t = momentum_[s][lane];
        momentum_[s][lane] = 0.5F * (1.0F + std::sqrt(1.0F + 4.0F * t * t));
        beta[s][lane] = (t - 1.0F) / momentum_[s][lane];
      }
    }
    return beta;
  }

  /// The slopes at y, in the place of the dose before.
  void residual(const Problem& problem, const Iterate& iterate, const PerSlice& beta) {
    for_values(iterate.dose, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const float now = iterate.dose[s].values[i];
        float& before = before_.dose[s].values[i];
        const float ahead = now + beta[s][i % lanes] * (now - before);
        before = slope(problem, window(problem, s, i % lanes), s, i, ahead);
      }
    });
  }

  /// A slice whose loss went up goes on with a shorter step, without momentum.
  void safeguard(const Problem& problem, const Operator& light, Iterate& iterate) {
    const PerSlice back = go_back(iterate, before_, loss_, losses(problem, light, iterate));
    for (std::size_t s = 0; s < back.size(); ++s) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        if (back[s][lane] == 0.0F) continue;
        momentum_[s][lane] = 1.0F;
        length_[s][lane] *= shorter;
      }
    }
    if (widen(problem)) loss_ = losses(problem, light, iterate);
  }

  [[nodiscard]] PerSlice losses(const Problem& problem, const Operator& light, const Iterate& iterate) const {
    return pooled(summed(iterate.dose,
                         [&](std::size_t s, std::size_t i) {
                           return loss(problem, window(problem, s, i % lanes), s, i, iterate.dose[s].values[i]);
                         }),
                  light);
  }

  [[nodiscard]] Window window(const Problem& problem, std::size_t s, std::size_t lane) const {
    const double middle = problem.demands.window.threshold();
    const auto half = static_cast<double>(half_width_[s][lane]);
    return {middle - half, middle + half};
  }

  /// A slice that has nearly what was asked of it, is asked for more: its window grows about the threshold, so that
  /// easy parts get the widest process window they can and hard ones are not asked for what they cannot reach.
  bool widen(const Problem& problem) {
    if (problem.demands.grey) return false;
    bool any = false;
    for (std::size_t s = 0; s < half_width_.size(); ++s) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        float& half = half_width_[s][lane];
        // One voxel that misses by a fifth of the half width costs so much.
        const bool close = loss_[s][lane] <= 0.5F * close_enough * close_enough * half * half;
        if (!close || half * wider > widest) continue;
        half *= wider;
        any = true;
      }
    }
    return any;
  }

  Iterate before_;
  std::vector<Slab> update_;
  PerSlice momentum_, length_, loss_;
  PerSlice half_width_;  // of each slice's window about the threshold
  std::vector<std::vector<std::uint16_t>> active_;
};

}  // namespace

std::unique_ptr<Method> make_apg(const MethodOptions& options) { return std::make_unique<Apg>(options); }

}  // namespace vam::optimize

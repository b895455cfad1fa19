// Accelerated projected gradient: FISTA (Beck & Teboulle 2009) on the one-sided quadratic loss, with the ramp filter as
// preconditioner and restarts (O'Donoghue & Candes 2015).
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "optimize/loss.hpp"
#include "optimize/method.hpp"
#include "optimize/step_length.hpp"

namespace vam::optimize {

namespace {

constexpr float shorter = 0.7F;  // measured on a 512 x 512 resolution target; 0.5 and 0.9 do a little worse

constexpr double close_enough = 0.2;  // of the half width of a slice's window
constexpr double wider = 1.1;
constexpr double widest = 0.3;  // half width, in doses

class Apg final : public Method {
 public:
  using Method::Method;

  void start(const Problem& problem, const Operator& light, Iterate& iterate) override {
    Method::start(problem, light, iterate);
    const PerSlice factor = to_common_threshold(metrics(iterate.dose, problem), problem);
    scale(iterate.g, factor);
    scale(iterate.dose, factor);
    prepare(problem, light, iterate);
  }

  void resume(const Problem& problem, const Operator& light, Iterate& iterate) override {
    Method::resume(problem, light, iterate);
    prepare(problem, light, iterate);
  }

  /// y = g_k + beta (g_k - g_{k-1}); g_{k+1} = max(0, y - s P A r(A* y)), where P is the floored ramp, r the slope of
  /// the loss, and A* y comes free from the doses of g_k and g_{k-1}.
  void step(const Problem& problem, const Operator& light, Iterate& iterate) override {
    PerSlice beta = advance();
    residual(problem, iterate, beta);
    light.forward(residual_, update_);
    hold_active(iterate, beta);
    light.precondition(update_);
    for_values(iterate.g, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const float now = iterate.g[s].values[i];
        const float ahead = now + beta[s][i % lanes] * (now - before_.g[s].values[i]);
        before_.g[s].values[i] = now;
        const float next = std::clamp(ahead - length_[s][i % lanes] * update_[s].values[i], 0.0F, peak_);
        iterate.g[s].values[i] = active(s, i) ? std::clamp(ahead, 0.0F, peak_) : next;
      }
    });
    std::swap(iterate.dose, before_.dose);
    light.adjoint(iterate.g, iterate.dose);
    safeguard(problem, iterate);
  }

  [[nodiscard]] int usual_iterations() const override { return 60; }

 private:
  void prepare(const Problem& problem, const Operator& light, const Iterate& iterate) {
    before_ = iterate;
    update_ = iterate.g;
    residual_ = iterate.dose;
    active_.assign(iterate.g.size(), std::vector<std::uint16_t>(iterate.g[0].values.size() / lanes));
    peak_ = options_.peak > 0 ? static_cast<float>(options_.peak * light.row_angle_rad()) : 3e38F;
    const double largest = largest_eigenvalue(light, problem);
    length_.assign(iterate.g.size(), {});
    for (auto& lane : length_) lane.fill(static_cast<float>(1.0 / largest));
    momentum_.assign(iterate.g.size(), {});
    for (auto& lane : momentum_) lane.fill(1.0F);
    window_.assign(iterate.g.size(), {});
    for (auto& lane : window_) lane.fill(problem.window);
    loss_ = losses(problem, iterate);
  }

  /// Values at a bound that the plain gradient would push beyond it are held there, and only the others take part in
  /// the preconditioned step: clipping a step along P would not go downhill (two-metric projection, Bertsekas 1982).
  void hold_active(const Iterate& iterate, const PerSlice& beta) {
    for_values(iterate.g, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; i += lanes) {
        unsigned bits = 0;
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const float now = iterate.g[s].values[i + lane];
          const float ahead = now + beta[s][lane] * (now - before_.g[s].values[i + lane]);
          float& u = update_[s].values[i + lane];
          const bool held = (ahead <= 0 && u > 0) || (ahead >= peak_ && u < 0);
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

  void residual(const Problem& problem, const Iterate& iterate, const PerSlice& beta) {
    for_values(residual_, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const float now = iterate.dose[s].values[i];
        const float ahead = now + beta[s][i % lanes] * (now - before_.dose[s].values[i]);
        residual_[s].values[i] = slope(ahead, problem.labels[s][i], window_[s][i % lanes]);
      }
    });
  }

  /// A slice whose loss went up goes back to where it was and on with a shorter step, without momentum. So the loss
  /// never rises.
  void safeguard(const Problem& problem, Iterate& iterate) {
    const PerSlice now = losses(problem, iterate);
    PerSlice back(now.size());
    bool any = false;
    for (std::size_t s = 0; s < now.size(); ++s) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        back[s][lane] = now[s][lane] > loss_[s][lane] ? 1.0F : 0.0F;
        if (back[s][lane] == 0.0F) {
          loss_[s][lane] = now[s][lane];
          continue;
        }
        any = true;
        momentum_[s][lane] = 1.0F;
        length_[s][lane] *= shorter;
      }
    }
    if (any) {
      restore(iterate.g, before_.g, back);
      restore(iterate.dose, before_.dose, back);
    }
    if (widen(problem, iterate)) loss_ = losses(problem, iterate);
  }

  [[nodiscard]] PerSlice losses(const Problem& problem, const Iterate& iterate) const {
    return summed(iterate.dose, [&](std::size_t s, std::size_t i) {
      const float d = slope(iterate.dose[s].values[i], problem.labels[s][i], window_[s][i % lanes]);
      return 0.5F * d * d;
    });
  }

  /// A slice that has nearly what was asked of it, is asked for more: its window grows about the threshold, so that
  /// easy parts get the widest process window they can and hard ones are not asked for what they cannot reach.
  bool widen(const Problem& problem, const Iterate& iterate) {
    bool any = false;
    for (std::size_t s = 0; s < window_.size(); ++s) {
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        Window& window = window_[s][lane];
        const double half = 0.5 * (window.high - window.low);
        // One voxel that misses by a fifth of the half width costs so much.
        if (static_cast<double>(loss_[s][lane]) > 0.5 * close_enough * close_enough * half * half ||
            half * wider > widest)
          continue;
        const double middle = problem.window.threshold();
        window = {middle - wider * half, middle + wider * half};
        any = true;
      }
    }
    return any && !iterate.dose.empty();
  }

  Iterate before_;
  std::vector<Slab> update_, residual_;
  std::vector<std::array<Window, lanes>> window_;
  PerSlice momentum_, length_, loss_;
  float peak_ = 0;
  std::vector<std::vector<std::uint16_t>> active_;
};

}  // namespace

std::unique_ptr<Method> make_apg(const MethodOptions& options) { return std::make_unique<Apg>(options); }

}  // namespace vam::optimize

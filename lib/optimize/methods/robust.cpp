// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/methods/private/robust.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "optimize/methods/private/loss.hpp"
#include "optimize/methods/private/safeguard.hpp"
#include "optimize/methods/private/surface_points.hpp"
#include "optimize/methods/private/two_metric.hpp"
#include "optimize/methods/scenarios.hpp"
#include "optimize/methods/step_length.hpp"

namespace vam::optimize {

namespace {

constexpr int nominal_steps = 8;
constexpr float third = 1.0F / 3.0F;
constexpr float most_momentum = 0.95F;

constexpr double window_share = 0.017;  // of the half width of the window, RMS over the voxels constrained
constexpr float wider_factor = 1.1F;
constexpr float widest_half_width = 0.3F;  // half width, in doses

double constrained_voxels(const Problem& problem) {
  double count = 0;
  for (const auto& labels : problem.labels)
    count += static_cast<double>(std::count_if(labels.begin(), labels.end(), is_constrained));
  return std::max(count, 1.0);
}

class Robust final : public Method {
 public:
  explicit Robust(const MethodOptions& options) : Method(options), nominal_(make_method("apg", options)) {}

  void start(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    nominal_->start(problem, light, iterate);
  }
  void resume(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    nominal_->resume(problem, light, iterate);
  }

  void step(const Problem& problem, const light::Operator& light, Iterate& iterate) override {
    if (done_ < nominal_steps) {
      nominal_->allow(options_.max_intensity);
      nominal_->step(problem, light, iterate);
    } else {
      if (done_ == nominal_steps) begin(problem, light, iterate);
      tolerant_step(problem, light, iterate);
    }
    ++done_;
  }

  [[nodiscard]] bool asks_more() const override { return true; }

  void exchange(Archive& archive) override {
    nominal_->exchange(archive);
    archive(before_.g);
    archive(before_.dose);
    archive(momentum_);
    archive(length_);
    archive(half_width_);
    archive(done_);
  }

  [[nodiscard]] bool keeps_scale() const override { return true; }

 private:
  void begin(const Problem& problem, const light::Operator& light, const Iterate& iterate) {
    before_ = iterate;
    length_ = static_cast<float>(1.0 / largest_eigenvalue(light, problem));
    momentum_ = 1;
    half_width_ = static_cast<float>(0.5 * (problem.demands.window.high - problem.demands.window.low));
    nominal_ = make_method("apg", options_);  // its state is no longer needed
  }

  void tolerant_step(const Problem& problem, const light::Operator& light, Iterate& iterate) {
    const float peak = largest_light(options_, light);
    const float beta = advance();
    if (!surface_) surface_.emplace(problem);
    std::vector<Slab> ahead = look_ahead(iterate, beta);
    std::vector<Slab> update = gradient(problem, light, iterate, beta, ahead);
    bounds_.fix_active_bounds(update, peak, [&](std::size_t s, std::size_t i) { return ahead[s].values[i]; });
    light.precondition(update);
    std::swap(iterate.g, before_.g);
    for_values(iterate.g, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        iterate.g[s].values[i] = bounds_.step(s, i, ahead[s].values[i], length_ * update[s].values[i], peak);
      }
    });
    std::swap(iterate.dose, before_.dose);
    light.adjoint(iterate.g, iterate.dose);
    if (overshoots(ahead, iterate.g)) momentum_ = 1;
    widen(problem);
  }

  /// t := (1 + sqrt(1 + 4 t^2)) / 2, beta = (t_before - 1) / t.
  float advance() {
    const float t = momentum_;
    momentum_ = 0.5F * (1.0F + std::sqrt(1.0F + 4.0F * t * t));
    return std::min((t - 1.0F) / momentum_, most_momentum);
  }

  /// y = g + beta (g - g before).
  [[nodiscard]] std::vector<Slab> look_ahead(const Iterate& iterate, float beta) const {
    std::vector<Slab> y = iterate.g;
    for_values(y, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) y[s].values[i] += beta * (y[s].values[i] - before_.g[s].values[i]);
    });
    return y;
  }

  /// Gradient of the mean loss at y; overwrites the dose before.
  std::vector<Slab> gradient(const Problem& problem, const light::Operator& light, const Iterate& iterate, float beta,
                             std::span<const Slab> y) {
    std::vector<Slab>& slopes = before_.dose;
    for_values(slopes, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        const float now = iterate.dose[s].values[i];
        slopes[s].values[i] = now + beta * (now - slopes[s].values[i]);
      }
    });
    loss_ = 0;
    to_slopes(problem, slopes);
    std::vector<Slab> sum = slabs(y.size(), light.sinogram().width, light.sinogram().height);
    light.forward(slopes, sum);
    std::vector<Slab> part = slabs(y.size(), light.sinogram().width, light.sinogram().height);
    const auto [one, other] = scenarios_->drawn(done_);
    for (const int scenario : {one, other}) {
      scenarios_->adjoint(scenario, y, slopes);
      to_slopes(problem, slopes);
      scenarios_->forward(scenario, slopes, part);
      for_values(sum, [&](std::size_t s, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) sum[s].values[i] += part[s].values[i];
      });
    }
    return sum;
  }

  /// Doses become the slopes of their loss, a third of each: three lights are looked at.
  void to_slopes(const Problem& problem, std::vector<Slab>& doses) {
    const DoseWindow now = window(problem);
    const std::vector<float> misses = surface_->misses(doses);
    const PerSlice losses = summed(doses, [&](std::size_t s, std::size_t i) {
      const float d = doses[s].values[i];
      const float r = slope(problem, now, s, i, d);
      doses[s].values[i] = third * r;
      return third * 0.5F * r * bounds(problem, now, s, i).miss(d);
    });
    for (const auto& lane : losses) {
      for (const float v : lane) loss_ += v;
    }
    surface_->add_slopes(misses, doses, third);
  }

  /// The window grows about the threshold while nearly all doses of all lights are outside it, as in apg.
  void widen(const Problem& problem) {
    const double half = half_width_;
    const double close = 0.5 * window_share * window_share * half * half * constrained_voxels(problem);
    if (loss_ <= close && half_width_ * wider_factor <= widest_half_width) half_width_ *= wider_factor;
  }

  [[nodiscard]] DoseWindow window(const Problem& problem) const {
    const double middle = problem.demands.window.threshold();
    return {middle - static_cast<double>(half_width_), middle + static_cast<double>(half_width_)};
  }

  /// The step leads back: <y - g, g - g before> > 0 [OC15].
  [[nodiscard]] bool overshoots(std::span<const Slab> y, std::span<const Slab> g) const {
    const PerSlice along = summed(y, [&](std::size_t s, std::size_t i) {
      const float now = g[s].values[i];
      return (y[s].values[i] - now) * (now - before_.g[s].values[i]);
    });
    double sum = 0;
    for (const auto& lane : along) {
      for (const float v : lane) sum += v;
    }
    return sum > 0;
  }

  std::unique_ptr<Method> nominal_;
  int done_ = 0;  // steps
  Iterate before_;
  float momentum_ = 1, length_ = 0, half_width_ = 0;
  double loss_ = 0;  // at the last y
  std::optional<SurfacePoints> surface_;
  TwoMetric bounds_;
};

}  // namespace

std::unique_ptr<Method> make_robust(const MethodOptions& options) { return std::make_unique<Robust>(options); }

}  // namespace vam::optimize

#include "optimize/run/certify.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "optimize/methods/method.hpp"
#include "optimize/methods/metrics.hpp"

namespace vam::optimize {

namespace {

constexpr int stages = 4;
constexpr int look_every = 5;

constexpr std::array even_shares{0.003, 0.03, 0.3, 1.0};

/// Weight in the void beside z: so much of z, and so much on each voxel.
struct More {
  double like_z, even;
};

/// The slopes of the quadratic loss come ever nearer to A y <= A z while it is minimised; what is missing is made up
/// for by more weight in the void.
class Prover {
 public:
  Prover(const Problem& problem, const light::Operator& light) : problem_(problem), light_(light) {
    const std::size_t count = problem.target.size();
    weights_ = slabs(count, light.object().width, light.object().height);
    rays_ = void_rays_ = even_rays_ = slabs(count, light.sinogram().width, light.sinogram().height);
    weigh([](Label label, std::size_t, std::size_t) { return label == Label::void_ ? 1.0F : 0.0F; });
    void_voxels_ = total([&](std::size_t s, std::size_t i) { return weights_[s].values[i]; });
    light.forward(weights_, even_rays_);
    find_free();
  }

  /// By the dose of some light, for the window that it was to have.
  void look(std::span<const Slab> dose, const DoseWindow& window) {
    const model::DoseMetrics m = body_metrics(dose, problem_);
    const double ratio = m.min_part > 0 ? m.max_void / m.min_part : 0;
    if (ratio > 0 && (proof_.reached == 0 || ratio < proof_.reached)) proof_.reached = ratio;
    const auto low = static_cast<float>(window.low);
    const auto high = static_cast<float>(window.high);
    const auto excess = [&](Label label, std::size_t s, std::size_t i) {
      return label == Label::void_ ? std::max(dose[s].values[i] - low, 0.0F) : 0.0F;
    };
    weigh(excess);
    light_.forward(weights_, void_rays_);
    const double beside = total([&](std::size_t s, std::size_t i) { return weights_[s].values[i]; });
    weigh([&](Label label, std::size_t s, std::size_t i) {
      if (label != Label::part) return excess(label, s, i);
      return free_[s].values[i] > 0 ? 0.0F : std::min(dose[s].values[i] - high, 0.0F);
    });
    light_.forward(weights_, rays_);
    const double part = total([&](std::size_t s, std::size_t i) { return std::max(-weights_[s].values[i], 0.0F); });
    for (const double share : even_shares) {
      const More more = missing(share, beside);
      const double all = beside * (1 + more.like_z) + more.even * void_voxels_;
      if (all > 0 && part / all > proof_.least) keep(part / all, more, all);
    }
  }

  [[nodiscard]] const Certificate& proof() const { return proof_; }

 private:
  /// Part voxels that are reached by rays through almost no void: lighting them costs nothing, so they cannot carry
  /// weight in the proof.
  void find_free() {
    constexpr float next_to_none = 0.02F;
    least_void_ = next_to_none * largest_of_all(largest(even_rays_))[0][0];
    for_values(rays_, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i)
        rays_[s].values[i] = even_rays_[s].values[i] < least_void_ ? 1.0F : 0.0F;
    });
    free_ = weights_;
    light_.adjoint(rays_, free_);
  }

  template <class Value>
  void weigh(const Value& value) {
    for_values(weights_, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) weights_[s].values[i] = value(problem_.labels[s][i], s, i);
    });
  }

  template <class Value>
  [[nodiscard]] double total(const Value& value) const {
    double sum = 0;
    for (const auto& lane : summed(weights_, value)) sum = std::accumulate(lane.begin(), lane.end(), sum);
    return sum;
  }

  /// What is added to z, of which a share is even, so that A z >= A y on every ray; a little more for rounding.
  [[nodiscard]] More missing(double share, double beside) const {
    constexpr float impossible = 1e30F;  // a ray through the part that meets no void
    constexpr double rounding = 1e-5;
    const auto like_z = static_cast<float>(beside > 0 ? (1 - share) / beside : 0);
    const auto even = static_cast<float>(share / void_voxels_);
    const PerSlice most = largest_of_all(reduce(
        rays_, 0.0F,
        [&](float& a, std::size_t s, std::size_t i) {
          if (even_rays_[s].values[i] < least_void_) return;  // no part with weight: what is short here is rounding
          const float short_by = -rays_[s].values[i];
          const float given = like_z * void_rays_[s].values[i] + even * even_rays_[s].values[i];
          if (short_by > 0) a = std::max(a, given > 0 ? std::min(short_by / given, impossible) : impossible);
        },
        larger));
    const double sum = (1 + rounding) * static_cast<double>(most[0][0]);
    return {sum * static_cast<double>(like_z), sum * static_cast<double>(even)};
  }

  void keep(double least, const More& more, double all) {
    proof_.least = least;
    proof_.weights = weights_;
    for_values(weights_, [&](std::size_t s, std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        double weight = static_cast<double>(weights_[s].values[i]);
        if (problem_.labels[s][i] == Label::void_) weight = weight * (1 + more.like_z) + more.even;
        proof_.weights[s].values[i] = static_cast<float>(weight / all);
      }
    });
  }

  const Problem& problem_;
  const light::Operator& light_;
  std::vector<Slab> weights_, free_, rays_, void_rays_, even_rays_;
  float least_void_ = 0;  // of all void in a ray that counts
  double void_voxels_ = 0;
  Certificate proof_;
};

/// About the same threshold, max_V / min_G = ratio at its edges.
DoseWindow window_of(double threshold, double ratio) {
  const double high = 2 * threshold / (1 + ratio);
  return {ratio * high, high};
}

}  // namespace

Certificate certify(const Problem& problem, const light::Operator& light, std::vector<Slab> g, int iterations) {
  Problem harder = problem;
  harder.demands.free_surface = true;
  Prover prover(problem, light);
  Iterate state;
  state.g = std::move(g);
  state.dose = slabs(state.g.size(), light.object().width, light.object().height);
  light.adjoint(state.g, state.dose);
  prover.look(state.dose, problem.demands.window);
  for (int stage = 0; stage < stages && prover.proof().reached > 0; ++stage) {
    // A window that no light has; its loss stays, and its slopes prove more than it asks for.
    const Certificate& so_far = prover.proof();
    const double ratio = std::max(0.5 * (so_far.least + so_far.reached), 0.9 * so_far.reached);
    harder.demands.window = window_of(problem.demands.window.threshold(), std::min(ratio, 1.0));
    const auto method = make_method("apg", {});
    method->resume(harder, light, state);
    for (int i = 1; i <= iterations / stages; ++i) {
      method->step(harder, light, state);
      if (i % look_every == 0) prover.look(state.dose, harder.demands.window);
    }
  }
  return prover.proof();
}

}  // namespace vam::optimize

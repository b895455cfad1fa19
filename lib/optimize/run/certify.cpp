// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/certify.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "base/compute/per_slice.hpp"
#include "base/log/progress.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/methods/saddle.hpp"
#include "optimize/methods/step_length.hpp"

namespace vam::optimize {

namespace {

constexpr int look_every = 20;
constexpr int prove_every = 100;
constexpr int few_rounds = 4;
constexpr int most_rounds = 12;

constexpr std::array even_shares{0.003, 0.03, 0.3, 1.0};

/// The light in the middle of whose window is 1.
std::vector<Slab> at_one(const Problem& problem, const light::Operator& light, std::vector<Slab> g) {
  std::vector<Slab> dose = slabs(g.size(), light.object().width, light.object().height);
  light.adjoint(g, dose);
  const model::DoseMetrics m = body_metrics(dose, problem);
  const double middle = 0.5 * (m.min_part + m.max_void);
  if (middle > 0) scale(g, filled(g.size(), static_cast<float>(1 / middle)));
  return g;
}

/// Weight in the void beside z: so much of z, and so much on each voxel.
struct ExtraWeight {
  double like_z, even;
};

/// Weights of the iteration come near to A y <= A z; what is missing is compensated by more weight in the void.
class Prover {
 public:
  Prover(const Problem& problem, const light::Operator& light) : problem_(problem), light_(light) {
    const std::size_t count = problem.target.size();
    weights_ = more_ = slabs(count, light.object().width, light.object().height);
    rays_ = even_rays_ = short_ = slabs(count, light.sinogram().width, light.sinogram().height);
    weigh(weights_, [](Label label, std::size_t, std::size_t) { return label == Label::void_ ? 1.0F : 0.0F; });
    void_voxels_ = sum_of(weights_, 1);
    light.forward(weights_, even_rays_);
    find_cheap_part();
  }

  /// 1 for part, -1 for void.
  [[nodiscard]] std::vector<Slab> sign() {
    weigh(weights_, [&](Label label, std::size_t, std::size_t) {
      if (label == Label::void_) return -1.0F;
      return label == Label::part ? 1.0F : 0.0F;
    });
    return weights_;
  }

  /// max_V x / min_G x of the light where it is not negative.
  [[nodiscard]] double ratio_of(const SaddlePoint& point) {
    fill(rays_, [&](std::size_t s, std::size_t i) { return std::max(point.light[s].values[i], 0.0F); });
    light_.adjoint(rays_, more_);
    const model::DoseMetrics m = body_metrics(more_, problem_);
    return m.min_part > 0 ? m.max_void / m.min_part : 0;
  }

  /// Weight in the void along the rays that are short of it, in some rounds; then so much that no ray is.
  [[nodiscard]] Certificate prove(const SaddlePoint& point, int rounds) {
    weigh(weights_,
          [&](Label, std::size_t s, std::size_t i) { return cheap_[s][i] != 0 ? 0.0F : -point.weights[s].values[i]; });
    light_.forward(weights_, short_);
    fill(short_, [&](std::size_t s, std::size_t i) { return -short_[s].values[i]; });
    for (int round = 0; round < rounds; ++round) fill_in();
    light_.forward(weights_, short_);
    fill(short_, [&](std::size_t s, std::size_t i) { return -short_[s].values[i]; });
    weigh(more_, [&](Label, std::size_t s, std::size_t i) { return std::max(weights_[s].values[i], 0.0F); });
    light_.forward(more_, rays_);
    const double beside = sum_of(weights_, 1);
    const double part = sum_of(weights_, -1);
    Certificate proof;
    for (const double share : even_shares) {
      const ExtraWeight more = missing(share, beside);
      const double all = beside * (1 + more.like_z) + more.even * void_voxels_;
      if (all > 0 && part / all > proof.least) proof = scaled(part / all, more, all);
    }
    return proof;
  }

 private:
  template <class Value>
  void weigh(std::span<Slab> volume, const Value& value) {
    fill(volume, [&](std::size_t s, std::size_t i) { return value(problem_.labels[s][i], s, i); });
  }

  /// Part that is reached by rays through almost no void: lighting it costs nothing, so that it cannot carry weight in
  /// the proof.
  void find_cheap_part() {
    constexpr float next_to_none = 0.02F;
    least_void_ = next_to_none * largest_of_all(largest(even_rays_))[0][0];
    fill(rays_, [&](std::size_t s, std::size_t i) { return needs_void(s, i) ? 0.0F : 1.0F; });
    light_.adjoint(rays_, more_);
    for (std::size_t s = 0; s < more_.size(); ++s) {
      std::vector<char> cheap(more_[s].values.size());
      for (std::size_t i = 0; i < cheap.size(); ++i) {
        cheap[i] = problem_.labels[s][i] == Label::part && more_[s].values[i] > 0 ? 1 : 0;
      }
      cheap_.push_back(std::move(cheap));
    }
  }

  /// Sum of the values of that sign.
  [[nodiscard]] static double sum_of(std::span<const Slab> images, float sign) {
    return total(images, [&](std::size_t s, std::size_t i) { return std::max(sign * images[s].values[i], 0.0F); });
  }

  /// On rays that meet hardly any void no part has weight, and what is short there is rounding.
  [[nodiscard]] bool needs_void(std::size_t s, std::size_t i) const { return even_rays_[s].values[i] >= least_void_; }
  [[nodiscard]] float missing_on(std::size_t s, std::size_t i) const {
    return needs_void(s, i) ? std::max(short_[s].values[i], 0.0F) : 0.0F;
  }

  /// One round: what a ray is short of is spread over the void that it meets, times the factor that gives the rays
  /// that are short what they need on average.
  void fill_in() {
    fill(rays_, [&](std::size_t s, std::size_t i) {
      const float missing = missing_on(s, i);
      return missing > 0 ? missing / even_rays_[s].values[i] : 0.0F;
    });
    light_.adjoint(rays_, more_);
    weigh(more_,
          [&](Label label, std::size_t s, std::size_t i) { return label == Label::void_ ? more_[s].values[i] : 0.0F; });
    light_.forward(more_, rays_);
    const double needed = total(rays_, [&](std::size_t s, std::size_t i) { return missing_on(s, i); });
    const double given =
        total(rays_, [&](std::size_t s, std::size_t i) { return missing_on(s, i) > 0 ? rays_[s].values[i] : 0.0F; });
    if (!(given > 0)) return;
    const auto factor = static_cast<float>(needed / given);
    fill(weights_, [&](std::size_t s, std::size_t i) { return weights_[s].values[i] + factor * more_[s].values[i]; });
    fill(short_, [&](std::size_t s, std::size_t i) { return short_[s].values[i] - factor * rays_[s].values[i]; });
  }

  /// Weight to add to z, a share of it evenly, so that A z >= A y on every ray.
  [[nodiscard]] ExtraWeight missing(double share, double beside) const {
    constexpr float impossible = 1e30F;  // a ray through the part that meets no void
    constexpr float rounding = 1e-5F;    // of A z
    const auto like_z = static_cast<float>(beside > 0 ? (1 - share) / beside : 0);
    const auto even = static_cast<float>(share / void_voxels_);
    const PerSlice most = largest_of_all(reduce(
        rays_, 0.0F,
        [&](float& a, std::size_t s, std::size_t i) {
          const float short_by = needs_void(s, i) ? short_[s].values[i] + rounding * rays_[s].values[i] : 0.0F;
          const float given = like_z * rays_[s].values[i] + even * even_rays_[s].values[i];
          if (short_by > 0) a = std::max(a, given > 0 ? std::min(short_by / given, impossible) : impossible);
        },
        larger));
    const auto sum = static_cast<double>(most[0][0]);
    return {sum * static_cast<double>(like_z), sum * static_cast<double>(even)};
  }

  [[nodiscard]] Certificate scaled(double least, const ExtraWeight& more, double all) {
    Certificate proof{least, 0, weights_};
    weigh(proof.weights, [&](Label label, std::size_t s, std::size_t i) {
      double weight = static_cast<double>(weights_[s].values[i]);
      if (label == Label::void_) weight = weight * (1 + more.like_z) + more.even;
      return static_cast<float>(weight / all);
    });
    return proof;
  }

  const Problem& problem_;
  const light::Operator& light_;
  std::vector<Slab> weights_, more_;            // z and -y; what is added to z
  std::vector<Slab> rays_, even_rays_, short_;  // A (y - z) in short_
  std::vector<std::vector<char>> cheap_;        // [slab][voxel]
  float least_void_ = 0;                        // of all void in a ray that counts
  double void_voxels_ = 0;
};

}  // namespace

Certificate certify(const Problem& problem, const light::Operator& given, std::vector<Slab> g, int iterations) {
  const auto quicker = problem.slices == 1 ? given.for_one_slice() : nullptr;
  const light::Operator& light = quicker ? *quicker : given;
  if (quicker) iterations *= 2;  // in less time
  Prover prover(problem, light);
  Saddle saddle(light, prover.sign(), largest_eigenvalue(light, problem));
  SaddleState state = saddle.begin(at_one(problem, light, std::move(g)));
  double reached = prover.ratio_of(state.now);
  Progress progress("proving", iterations);
  for (int i = 1; i <= iterations; ++i, progress.tick()) {
    saddle.step(state, {});
    if (i % look_every != 0 && i != iterations) continue;
    const double ratio = prover.ratio_of(saddle.point());
    if (ratio > 0 && (reached == 0 || ratio < reached)) reached = ratio;
    if (i % prove_every != 0) continue;
    if (prover.prove(saddle.point(), few_rounds).least >= (1 - proof_gap) * reached) break;
  }
  Certificate proof = prover.prove(saddle.point(), std::min(most_rounds, 1 + iterations / 20));
  proof.reached = reached;
  return proof;
}

}  // namespace vam::optimize

// SPDX-License-Identifier: GPL-3.0-or-later
// Projected gradient descent with a step that chooses itself, for any loss that is a sum over voxels.
#pragma once

#include "optimize/methods/method.hpp"

namespace vam::optimize {

/// g <- clamp(g - alpha A r(A* g), 0, g_max), r the slope of the loss. Each slice has its own alpha: at first Cauchy's,
/// then that of [BB88], <dg, dg> / <dg, A dr> = <dg, dg> / <dx, dr>, which needs no projection of its own.
/// A slice whose loss went up goes back and on with a shorter step, so that the loss never rises.
class Descent : public Method {
 public:
  using Method::Method;
  void start(const Problem& problem, const light::Operator& light, Iterate& iterate) override;
  void resume(const Problem& problem, const light::Operator& light, Iterate& iterate) override;
  void step(const Problem& problem, const light::Operator& light, Iterate& iterate) override;
  void exchange(Archive& archive) override;
  [[nodiscard]] bool keeps_scale() const override { return true; }

 protected:
  /// The loss of one voxel of slab s, and its derivative by the dose.
  [[nodiscard]] virtual float loss(const Problem& problem, std::size_t s, std::size_t i, float dose) const = 0;
  [[nodiscard]] virtual float slope(const Problem& problem, std::size_t s, std::size_t i, float dose) const = 0;

 private:
  void prepare(const Problem& problem, const light::Operator& light, Iterate& iterate);
  /// gradient = A (slopes at the iterate); the dose before is used up.
  void differentiate(const Problem& problem, const light::Operator& light, const Iterate& iterate);
  [[nodiscard]] PerSlice losses(const Problem& problem, const light::Operator& light,
                                const std::vector<Slab>& dose) const;
  void judge(const Problem& problem, const light::Operator& light, Iterate& iterate);

  Iterate before_;
  std::vector<Slab> gradient_;
  PerSlice length_, loss_;
};

}  // namespace vam::optimize

// SPDX-License-Identifier: GPL-3.0-or-later
// The least max_V x / min_G x of any light as the saddle of a bilinear form, and its primal-dual iteration.
#pragma once

#include <span>
#include <vector>

#include "light/operators/operator.hpp"
#include "optimize/target/problem.hpp"

namespace vam::optimize {

/// Light and weights with their products. The light is negative in places until the slack is settled.
struct SaddlePoint {
  std::vector<Slab> light;    // g
  std::vector<Slab> dose;     // A* g
  std::vector<Slab> weights;  // y >= 0 in the part, -z <= 0 in the void, sum z = 1
  std::vector<Slab> balance;  // A (y - z)
  std::vector<Slab> slack;    // u >= 0; in the end -A (y - z)
};

/// min over g, max over y, z and u of sum y - <y - z, A* g> - <u, g>. Primal-dual hybrid gradient [CP11], its light
/// preconditioned by the operator's ramp, drawn to an anchor that moves when the steps have become small [LY24].
class Saddle {
 public:
  /// `sign`: 1 for part that may carry weight, -1 for void, else 0. eigenvalue: the largest of P A A*. Begins with this
  /// light.
  Saddle(const light::Operator& light, std::vector<Slab> sign, std::vector<Slab> g, double eigenvalue);
  void step();
  /// Of the last step.
  [[nodiscard]] const SaddlePoint& point() const { return next_; }

 private:
  /// Squared changes of a step: of light, weights and slack, and what couples them.
  struct Change {
    double light = 0, weights = 0, slack = 0, coupled = 0;
    [[nodiscard]] double norm() const;
  };
  [[nodiscard]] double slack_step() const;
  void advance_light();
  void advance_slack();
  void advance_weights();
  void settle_level();
  [[nodiscard]] Change change() const;
  void draw_to_anchor();
  void move_anchor(const Change& change);

  const light::Operator& light_;
  std::vector<Slab> sign_;
  SaddlePoint now_, next_, anchor_;
  double eigenvalue_, largest_gain_;  // of P A A*, of P
  double weight_step_ = 0;
  double level_ = 0;  // the void's largest dose, nearly
  int steps_ = 0, since_ = 0;
  double first_change_ = 0, last_change_ = 0;
};

}  // namespace vam::optimize

// SPDX-License-Identifier: GPL-3.0-or-later
// The widest window about a threshold that light within a limit can reach, as the saddle of a bilinear form, and its
// primal-dual iteration.
#pragma once

#include <limits>
#include <vector>

#include "light/operators/operator.hpp"
#include "optimize/methods/archive.hpp"
#include "optimize/target/problem.hpp"

namespace vam::optimize {

/// Light and weights with their products. The light is out of bounds in places until the slack is settled.
struct SaddlePoint {
  std::vector<Slab> light;    // g
  std::vector<Slab> dose;     // A* g
  std::vector<Slab> weights;  // y >= 0 in the part, -z <= 0 in the void, sum y + sum z = 1
  std::vector<Slab> balance;  // A (y - z)
  std::vector<Slab> slack;    // u; in the end -A (y - z): above 0 where g is 0, below where it is the largest
};

/// State of the iteration.
struct SaddleState {
  SaddlePoint now, anchor;
  double weight_step = 0;
  double level = 0;  // -h, nearly
  int steps = 0, since = 0;
  double first_change = 0, last_change = 0;
  void exchange(Archive& archive);
};

/// max h, x >= t + h in the part, x <= t - h in the void, x = A* g, 0 <= g <= peak: the saddle
/// min over g, max over y, z and u of t (sum y - sum z) - <y - z, A* g> - <u, g>, less peak <u>_- where there is a
/// peak. Primal-dual hybrid gradient [CP11], its light preconditioned by the operator's ramp, drawn to an anchor that
/// moves when the steps have become small [LY24].
class Saddle {
 public:
  struct Aim {
    double threshold = 1;                            // t
    float peak = std::numeric_limits<float>::max();  // of a sinogram value
  };

  /// `sign`: 1 for part that may carry weight, -1 for void, else 0. eigenvalue: the largest of P A A*.
  Saddle(const light::Operator& light, std::vector<Slab> sign, double eigenvalue);
  /// Begins with this light.
  [[nodiscard]] SaddleState begin(std::vector<Slab> g) const;
  void step(SaddleState& state, const Aim& aim);
  /// The point of the last step.
  [[nodiscard]] const SaddlePoint& point() const { return next_; }
  /// No light within the peak has a larger h, by the weights of the last step: with <a>_+ the sum of what is above 0,
  /// h <= t (sum z - sum y) + peak <A (y - z)>_+.
  [[nodiscard]] double largest_margin(const Aim& aim) const;

 private:
  /// Squared changes of a step: of light, weights and slack, and what couples them.
  struct Change {
    double light = 0, weights = 0, slack = 0, coupled = 0;
    [[nodiscard]] double norm() const;
  };
  [[nodiscard]] double slack_step(const SaddleState& state) const;
  void advance_light(const SaddleState& state);
  void advance_slack(const SaddleState& state, float peak);
  void advance_weights(SaddleState& state, double threshold);
  void settle_level(SaddleState& state);
  [[nodiscard]] Change change(const SaddleState& state) const;
  void draw_to_anchor(SaddleState& state) const;
  void move_anchor(SaddleState& state, const Change& change) const;

  const light::Operator& light_;
  std::vector<Slab> sign_;
  SaddlePoint next_;
  double eigenvalue_, largest_gain_;  // of P A A*, of P
};

}  // namespace vam::optimize

// SPDX-License-Identifier: GPL-3.0-or-later
// Live views: the last full turn, and when a new volume is due.
#pragma once

#include <deque>
#include <vector>

#include "metrology/ost/views.hpp"

namespace vam::metrology {

/// Keeps the views of the last 360 degrees. Angles may be given modulo a turn and in either sense; a step of more than
/// half a turn between two frames cannot be distinguished from one in the opposite direction.
class SlidingTurn {
 public:
  /// A volume is due every `every_deg`, first after one full turn.
  explicit SlidingTurn(double every_deg) : every_deg_(every_deg) {}

  /// Takes a view; true when the last turn is complete and a volume is due.
  bool push(CameraView view);

  /// The views of the last turn, oldest first.
  [[nodiscard]] std::vector<CameraView> views() const { return {views_.begin(), views_.end()}; }
  /// Turns of the views, each of which stands for one mean step: a full turn with the last view before its closing one.
  [[nodiscard]] double turns() const { return (turned_deg_ + step_deg()) / 360; }
  /// Duration of a turn, from the times of the views of the last one; 0 where they have none.
  [[nodiscard]] double turn_s() const;

 private:
  [[nodiscard]] double step_deg() const;  // mean, of the last turn

  double every_deg_;
  double turned_deg_ = 0;
  double last_angle_deg_ = 0;
  double next_due_deg_ = 360;
  bool started_ = false;
  std::deque<CameraView> views_;
  std::deque<double> at_deg_;  // turned_deg_ of each view
};

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/sliding_turn.hpp"

#include <cmath>
#include <utility>

namespace vam::metrology {

bool SlidingTurn::push(CameraView view) {
  if (started_) turned_deg_ += std::abs(std::remainder(view.angle_deg - last_angle_deg_, 360.0));
  started_ = true;
  last_angle_deg_ = view.angle_deg;
  views_.push_back(std::move(view));
  at_deg_.push_back(turned_deg_);
  while (turned_deg_ - at_deg_.front() >= 360 - 1e-9) {  // what came a turn ago is replaced by what came now
    views_.pop_front();
    at_deg_.pop_front();
  }
  // The frame that closes the turn would repeat the first: one mean step less than 360 is a full turn.
  const double end_deg = turned_deg_ + step_deg();
  if (end_deg < next_due_deg_ - 1e-9) return false;
  while (next_due_deg_ <= end_deg + 1e-9) next_due_deg_ += every_deg_;
  return true;
}

double SlidingTurn::step_deg() const {
  if (views_.size() < 2) return 0;
  return (at_deg_.back() - at_deg_.front()) / static_cast<double>(views_.size() - 1);
}

double SlidingTurn::turn_s() const {
  const double turned_deg = views_.empty() ? 0 : at_deg_.back() - at_deg_.front();
  if (!(turned_deg > 0)) return 0;
  return (views_.back().time_s - views_.front().time_s) * 360 / turned_deg;
}

}  // namespace vam::metrology

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
  const double step =
      views_.size() > 1 ? (at_deg_.back() - at_deg_.front()) / static_cast<double>(views_.size() - 1) : 0;
  if (turned_deg_ + step < next_due_deg_ - 1e-9) return false;
  while (next_due_deg_ <= turned_deg_ + step + 1e-9) next_due_deg_ += every_deg_;
  return true;
}

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
// Stops the stage on the way out of a motion that fails.
#pragma once

#include "device/stage/stage.hpp"

namespace vam::device {

/// First in line; after it come the stage's own destructor and the guardian.
class StopOnExit {
 public:
  explicit StopOnExit(Stage& stage) : stage_(stage) {}
  ~StopOnExit() {
    if (!armed_) return;
    try {
      stage_.stop(Stop::abrupt);
      for (int look = 0; look < 50 && stage_.moving(); ++look) continue;
    } catch (...) {
      // The error that brought us here is the one to report; the guardian still holds its order.
    }
  }
  StopOnExit(const StopOnExit&) = delete;
  StopOnExit& operator=(const StopOnExit&) = delete;
  void disarm() { armed_ = false; }

 private:
  Stage& stage_;
  bool armed_ = true;
};

}  // namespace vam::device

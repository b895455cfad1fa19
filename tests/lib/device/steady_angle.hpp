// SPDX-License-Identifier: GPL-3.0-or-later
// A stage that turns for ever, at 30 deg/s.
#pragma once

#include "device/stage/angle_source.hpp"

namespace vam::device {

/// Through angle 0 at zero_s.
class Steady final : public AngleSource {
 public:
  explicit Steady(double zero_s) : zero_s_(zero_s) {}
  void update() override {}
  [[nodiscard]] std::optional<AngleSample> at(double t_s) const override {
    return AngleSample{t_s, 30 * (t_s - zero_s_), 0.01};
  }

 private:
  double zero_s_;
};

}  // namespace vam::device

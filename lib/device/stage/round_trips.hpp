// SPDX-License-Identifier: GPL-3.0-or-later
// When a stage was at the angle that it answered.
#pragma once

#include <limits>

#include "device/os/angle_sample.hpp"
#include "device/stage/stage.hpp"

namespace vam::device {

/// The times of a stage's answers: the middle of question and answer, corrected. What a round trip takes beyond the
/// shortest one is lost on either way, in a share that is learned: serial adapters and busy machines deliver answers
/// late, and the angle is then older than the middle. The moment is uncertain by what is not known of that share, and
/// by a third of the shortest, whose two ways may differ; of the first samples by the whole [physics §10]. Times the
/// speed, and with the step of the reported angle, that is the uncertainty of the angle.
class RoundTrips {
 public:
  [[nodiscard]] AngleSample timed(const StageSample& sample, double speed_deg_s);
  /// The sample that was timed last at its middle, whatever has been learned: what is fitted to these keeps its slope.
  [[nodiscard]] AngleSample middle() const { return at_share(0, seen_ <= enough); }
  /// That sample differs by so much from the angle expected at its middle.
  void learn(double off_deg, double speed_deg_s);
  /// Of the time beyond the shortest round trip: -0.5 where answers are late, 0.5 where questions are.
  [[nodiscard]] double share() const { return share_; }

 private:
  static constexpr long enough = 10;  // samples, after which the shortest round trip is taken as known
  [[nodiscard]] AngleSample at_share(double share, bool whole) const;
  StageSample last_;
  double speed_deg_s_ = 0;
  long seen_ = 0;
  double shortest_s_ = std::numeric_limits<double>::infinity();
  double beyond_s_ = 0, share_ = 0;
  double count_ = 0, sum_ = 0, sum_off_ = 0, squares_ = 0, products_ = 0;  // of beyond_s_ and the offsets in time
};

}  // namespace vam::device

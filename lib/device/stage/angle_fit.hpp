// The stage's angle as a straight line in time, fitted to its latest samples: what the angle is now and will be at the
// next flip.
#pragma once

#include <deque>
#include <limits>

#include "device/os/angle_sample.hpp"
#include "device/stage/stage.hpp"

namespace vam::device {

/// The times of a stage's answers: the middle of question and answer. What a round trip takes beyond the shortest one
/// may be lost on either way, so the moment is spread evenly over that (1/sqrt(12)), and over a third of the
/// shortest, whose two ways may differ; of the first samples over the whole [physics §10]. Times the speed, and with
/// the encoder's last digit, that is the uncertainty of the angle. A busy machine reads answers late, which moves the
/// middle to one side: such samples count little beside the shortest round trips.
class RoundTrips {
 public:
  [[nodiscard]] AngleSample timed(const StageSample& sample, double speed_deg_s);

 private:
  long seen_ = 0;
  double shortest_s_ = std::numeric_limits<double>::infinity();
};

/// Weighted least squares over the samples of the last window_s seconds.
class AngleFit {
 public:
  explicit AngleFit(double window_s = 1.0) : window_s_(window_s) {}
  void add(const AngleSample& sample);
  void clear() { samples_.clear(); }
  /// At least three samples over at least a quarter of the window.
  [[nodiscard]] bool ready() const;
  /// Both need ready(). sigma_deg is the fit's own uncertainty at t_s.
  [[nodiscard]] AngleSample at(double t_s) const;
  [[nodiscard]] double speed_deg_s() const;
  [[nodiscard]] double speed_sigma_deg_s() const;

 private:
  void solve() const;
  double window_s_;
  std::deque<AngleSample> samples_;
  mutable bool solved_ = false;
  mutable double mean_t_s_ = 0, mean_deg_ = 0, slope_ = 0, slope_variance_ = 0, mean_variance_ = 0;
};

}  // namespace vam::device

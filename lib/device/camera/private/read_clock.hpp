// SPDX-License-Identifier: GPL-3.0-or-later
// A camera's own clock, read by the host now and then: a time stamp is then a moment of the host's clock, however long
// its frame takes to arrive.
#pragma once

#include <deque>
#include <optional>

namespace vam::device {

/// The camera's clock showed device_s at a moment between these two of the host's clock.
struct ClockReading {
  double device_s = 0;
  double from_s = 0;
  double to_s = 0;
};

/// Host times by all readings at once: each bounds how far the host's clock is ahead, with what the clocks may have
/// drifted apart in its age. What all of them allow is narrower than any, and no reading that was held up moves it.
class ReadClock {
 public:
  void add(const ClockReading& reading);
  [[nodiscard]] bool ready() const { return !readings_.empty(); }
  /// By how much host_s() may be wrong now. Needs ready().
  [[nodiscard]] double doubt_s() const;
  /// The standard deviation of that: of a moment anywhere within. Needs ready().
  [[nodiscard]] double sigma_s() const;
  /// The host's time of a frame's stamp; nothing when it is not of this clock: later than the frame's arrival beyond
  /// doubt, or earlier by more than 10 s and its exposure. Needs ready().
  [[nodiscard]] std::optional<double> host_s(double device_s, double arrived_s, double exposure_s) const;

 private:
  struct Range {
    double from_s = 0;
    double to_s = 0;
  };
  // By how much the host's clock is ahead of the camera's at the last reading: by one of them, by all.
  [[nodiscard]] Range range(const ClockReading& reading) const;
  [[nodiscard]] Range ahead() const;
  std::deque<ClockReading> readings_;  // of the last 10 s, increasing in time
};

}  // namespace vam::device

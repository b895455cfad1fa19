// SPDX-License-Identifier: GPL-3.0-or-later
// Continuous frame numbers and times from the wrapping counters of cameras.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

namespace vam::device {

/// Turns a camera's own frame ids into numbers 0, 1, 2, ... that count every frame it made. Ids may begin anywhere and
/// come round after 65535 to 1 (GigE Vision: 0 is no id).
class FrameCount {
 public:
  /// The number of the frame with this id. Without one (its leader was lost), or with one that cannot be (more than
  /// 1000 frames ahead, or before the last), it is taken for the frame after the last.
  long number(std::optional<std::uint64_t> id);

 private:
  std::optional<std::uint64_t> last_id_;
  long last_ = -1;
};

/// Host times of a device's time stamps. A stamp is never later than its arrival, and the least delay of the last
/// window_s seconds is taken for all: the jitter of bus and scheduler goes, the clocks may drift.
class StampClock {
 public:
  explicit StampClock(double window_s = 10) : window_s_(window_s) {}
  double host_s(double device_s, double arrived_s);

 private:
  double window_s_;
  std::deque<std::pair<double, double>> delays_;  // device time, delay; increasing
};

}  // namespace vam::device

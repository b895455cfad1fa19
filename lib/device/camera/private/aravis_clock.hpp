// SPDX-License-Identifier: GPL-3.0-or-later
// The clock of a GenICam camera, by its time-stamp latch.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "device/camera/private/read_clock.hpp"
#include "device/os/clock.hpp"

struct _ArvCamera;  // NOLINT: Aravis' own name, whose header stays in the sources

namespace vam::device {

/// The latch of SFNC 2 (TimestampLatch, ns) or of GigE Vision (GevTimestampControlLatch, ticks).
class AravisClock {
 public:
  /// Reads the clock a few times, where the camera has a latch.
  AravisClock(_ArvCamera* camera, const std::string& name, Clock& clock);
  [[nodiscard]] bool ready() const { return camera_clock_.ready(); }
  /// Standard deviation of host_s(), the same for all frames of a while. Needs ready().
  [[nodiscard]] double sigma_s() const { return camera_clock_.sigma_s(); }
  /// Reads again when the last time is a second ago, as clocks drift.
  void refresh();
  /// The host's time of a frame's stamp; nothing, from then on, when a stamp is not of this clock.
  [[nodiscard]] std::optional<double> host_s(double device_s, double arrived_s, double exposure_s);

 private:
  void read(int times);
  [[nodiscard]] std::optional<ClockReading> reading(double limit_s);

  _ArvCamera* camera_;
  const std::string& name_;
  Clock& clock_;
  const char* latch_ = nullptr;
  const char* value_ = nullptr;
  double seconds_per_tick_ = 1e-9;
  std::int64_t last_ticks_ = 0;
  double read_s_ = 0;
  ReadClock camera_clock_;
};

}  // namespace vam::device

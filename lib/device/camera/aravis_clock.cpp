// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/private/aravis_clock.hpp"

#include <arv.h>

#include "base/log/log.hpp"
#include "device/camera/private/aravis_problem.hpp"

namespace vam::device {

namespace {
constexpr int first_readings = 12;                // some of them are held up, at either end
constexpr double wanted_s = 0.0002, first_s = 1;  // accuracy aimed at, and how long to try for it
constexpr int later_readings = 3;
constexpr double period_s = 1;
constexpr double latch_patience_s = 0.05;  // until the latched value is there
}  // namespace

AravisClock::AravisClock(_ArvCamera* camera, const std::string& name, Clock& clock)
    : camera_(camera), name_(name), clock_(clock) {
  struct Latch {
    const char* command;
    const char* value;
    bool in_ticks;
  };
  for (const auto& [command, value, in_ticks] : {Latch{"TimestampLatch", "TimestampLatchValue", false},
                                                 Latch{"GevTimestampControlLatch", "GevTimestampValue", true}}) {
    AravisProblem problem;
    const bool has = arv_camera_is_feature_available(camera, command, problem) != 0 &&
                     arv_camera_is_feature_available(camera, value, problem) != 0;
    if (!has || problem.there()) continue;
    if (in_ticks) {
      if (arv_camera_is_gv_device(camera) == 0) continue;
      const std::uint64_t rate_hz =
          arv_gv_device_get_timestamp_tick_frequency(ARV_GV_DEVICE(arv_camera_get_device(camera)), problem);
      if (problem.there() || rate_hz == 0) continue;
      seconds_per_tick_ = 1 / static_cast<double>(rate_hz);
    }
    const double begin_s = clock_.now_s();
    latch_ = command;
    value_ = value;
    last_ticks_ = arv_camera_get_integer(camera, value, problem);
    read(first_readings);
    while ((!ready() || camera_clock_.doubt_s() > wanted_s) && clock_.now_s() < begin_s + first_s) read(later_readings);
    return;
  }
}

void AravisClock::refresh() {
  if (ready() && clock_.now_s() > read_s_ + period_s) read(later_readings);
}

std::optional<double> AravisClock::host_s(double device_s, double arrived_s, double exposure_s) {
  if (!ready()) return std::nullopt;
  if (const auto stamped_s = camera_clock_.host_s(device_s, arrived_s, exposure_s)) return stamped_s;
  warn(name_ +
       ": its time stamps do not agree with the clock that it reports; the arrival times of the frames are used");
  camera_clock_ = ReadClock();
  return std::nullopt;
}

void AravisClock::read(int times) {
  read_s_ = clock_.now_s();
  for (int i = 0; i < times; ++i) {
    const double limit_s = clock_.now_s() + latch_patience_s;
    const auto found = reading(limit_s);
    if (!found && clock_.now_s() > limit_s + latch_patience_s) return;  // the camera does not answer
    if (found) camera_clock_.add(*found);
  }
}

// A value that is as it was has not been latched yet: the moment lies between the last such answer and the first other.
std::optional<ClockReading> AravisClock::reading(double limit_s) {
  AravisProblem problem;
  double from_s = clock_.now_s();
  arv_camera_execute_command(camera_, latch_, problem);
  while (!problem.there() && from_s < limit_s) {
    const double asked_s = clock_.now_s();
    const std::int64_t now = arv_camera_get_integer(camera_, value_, problem);
    if (problem.there()) break;
    if (now == last_ticks_) {
      from_s = asked_s;
      continue;
    }
    last_ticks_ = now;
    return ClockReading{seconds_per_tick_ * static_cast<double>(now), from_s, clock_.now_s()};
  }
  return std::nullopt;
}

}  // namespace vam::device

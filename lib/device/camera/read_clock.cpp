// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/private/read_clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vam::device {

namespace {
constexpr double window_s = 10;
constexpr double drift = 5e-5;   // two quartz clocks of 25 ppm
constexpr double late_s = 0.02;  // by which a time of arrival may be wrong
constexpr double early_s = 10;
}  // namespace

void ReadClock::add(const ClockReading& reading) {
  readings_.push_back(reading);
  while (readings_.front().to_s < reading.to_s - window_s) readings_.pop_front();
}

ReadClock::Range ReadClock::range(const ClockReading& reading) const {
  const double drifted_s = drift * (readings_.back().to_s - reading.to_s);
  return {reading.from_s - reading.device_s - drifted_s, reading.to_s - reading.device_s + drifted_s};
}

ReadClock::Range ReadClock::ahead() const {
  Range common{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Range narrowest = common;
  for (const ClockReading& reading : readings_) {
    const Range one = range(reading);
    common = {std::max(common.from_s, one.from_s), std::min(common.to_s, one.to_s)};
    if (one.to_s - one.from_s < narrowest.to_s - narrowest.from_s) narrowest = one;
  }
  return common.from_s <= common.to_s ? common : narrowest;  // of clocks that drift faster
}

double ReadClock::doubt_s() const {
  const Range range = ahead();
  return 0.5 * (range.to_s - range.from_s);
}

double ReadClock::sigma_s() const { return doubt_s() / std::sqrt(3.0); }

std::optional<double> ReadClock::host_s(double device_s, double arrived_s, double exposure_s) const {
  const Range range = ahead();
  const double stamped_s = device_s + 0.5 * (range.from_s + range.to_s);
  const double doubt_s = 0.5 * (range.to_s - range.from_s);
  if (stamped_s > arrived_s + doubt_s + late_s || stamped_s < arrived_s - early_s - exposure_s) return std::nullopt;
  return stamped_s;
}

}  // namespace vam::device

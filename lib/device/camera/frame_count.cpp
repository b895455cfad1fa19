// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/camera/private/frame_count.hpp"

namespace vam::device {

namespace {
constexpr std::uint64_t gige_ids = 65535;  // 1 ... 65535
constexpr std::uint64_t believable_gap = 1000;
}  // namespace

long FrameCount::number(std::optional<std::uint64_t> id) {
  std::uint64_t step = 1;
  if (id && last_id_) {
    const bool came_round = *id <= *last_id_ && *last_id_ <= gige_ids;
    step = came_round ? *id + gige_ids - *last_id_ : *id - *last_id_;
    if (step == 0 || step > believable_gap) {
      step = 1;
      id.reset();
    }
  }
  last_ += static_cast<long>(step);
  if (id) {
    last_id_ = id;
  } else if (last_id_) {
    last_id_ = *last_id_ == gige_ids ? 1 : *last_id_ + 1;
  }
  return last_;
}

double StampClock::host_s(double device_s, double arrived_s) {
  const double delay_s = arrived_s - device_s;
  while (!delays_.empty() && (delays_.front().first < device_s - window_s_ || delays_.front().first > device_s)) {
    delays_.pop_front();
  }
  while (!delays_.empty() && delays_.back().second >= delay_s) delays_.pop_back();
  delays_.emplace_back(device_s, delay_s);
  return device_s + delays_.front().second;
}

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/clock.hpp"

#include <poll.h>

#include <cmath>
#include <ctime>

#include "device/os/interrupt.hpp"

namespace vam::device {

namespace {

class RealClock final : public Clock {
 public:
  double now_s() override {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  void sleep_until(double t_s) override {
    for (;;) {
      check_interrupted();
      const double left_s = t_s - now_s();
      if (left_s <= 0) return;
      const double whole_s = std::floor(left_s);
      const timespec left{static_cast<time_t>(whole_s), static_cast<long>((left_s - whole_s) * 1e9)};
      pollfd waker{interrupt_fd(), POLLIN, 0};
      ppoll(&waker, 1, &left, nullptr);
    }
  }
};

}  // namespace

Clock& real_clock() {
  static RealClock clock;
  return clock;
}

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <utility>

#include "base/index.hpp"
#include "device/projector/display_backends.hpp"

namespace vam::device {

namespace {

class NullDisplay final : public Display {
 public:
  NullDisplay(const DisplayMode& mode, int miss, Clock& clock)
      : mode_(mode), miss_(miss), clock_(clock), origin_s_(clock.now_s()) {}

  DisplayMode mode() const override { return mode_; }

  int add(const GreyImage& levels) override {
    (void)screen_bytes(levels, mode_);  // what would not fit a screen does not fit this one
    return count_++;
  }

  void exchange(ScreenFrames& frames) override { count_ = count_of(frames); }

  Flip present(int) override {
    auto sequence = static_cast<long>(std::floor((clock_.now_s() - origin_s_) * mode_.hz)) + 1;
    if (miss_ > 0 && ++presented_ % miss_ == 0) ++sequence;
    const double time_s = origin_s_ + static_cast<double>(sequence) / mode_.hz;
    clock_.sleep_until(time_s + 1e-6);  // past the blank, so that rounding does not show it twice
    return {sequence, time_s};
  }

 private:
  DisplayMode mode_;
  int miss_;
  Clock& clock_;
  double origin_s_;
  int count_ = 0;
  long presented_ = 0;
};

}  // namespace

std::unique_ptr<Display> open_null_display(const Address& address, const DisplayMode& wanted, Clock& clock, Guardian*) {
  DisplayMode mode = wanted;
  mode.hz = address.number("hz", wanted.hz, 5, 1000);  // every blank is a heartbeat
  return std::make_unique<NullDisplay>(mode, address.integer("miss", 2, 1000000).value_or(0), clock);
}

}  // namespace vam::device

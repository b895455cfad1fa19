// SPDX-License-Identifier: GPL-3.0-or-later
// Time is injected, so that tests of minutes of motion take milliseconds.
#pragma once

namespace vam::device {

/// Seconds since an arbitrary start that never step back. The real clock is CLOCK_MONOTONIC, which all processes of a
/// machine share: times may be handed from tool to tool.
class Clock {
 public:
  virtual ~Clock() = default;
  [[nodiscard]] virtual double now_s() = 0;
  /// Returns at once when t_s has passed. The real clock throws Interrupted when a signal asks the tool to end.
  virtual void sleep_until(double t_s) = 0;
};

/// CLOCK_MONOTONIC.
Clock& real_clock();

/// A clock that moves only when somebody sleeps.
class VirtualClock final : public Clock {
 public:
  explicit VirtualClock(double start_s = 1000) : now_s_(start_s) {}
  [[nodiscard]] double now_s() override { return now_s_; }
  void sleep_until(double t_s) override {
    if (t_s > now_s_) now_s_ = t_s;
  }

 private:
  double now_s_;
};

}  // namespace vam::device

// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/blinking_screen.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vam::oracle {

namespace {

constexpr double before_s = 1;  // that the screen blinks before the camera begins, and after it ends
constexpr double finest_s = 5e-5;

using Uniform = std::uniform_real_distribution<double>;

std::vector<std::pair<double, bool>> show(const ScreenTruth& screen, double seconds, std::mt19937_64& random) {
  std::vector<std::pair<double, bool>> flips;
  const double phase_s = Uniform(0, 1 / screen.hz)(random);
  for (long blank = 0; static_cast<double>(blank) / screen.hz < seconds; ++blank) {
    if (Uniform()(random) < screen.missed) continue;
    const double since_s = static_cast<double>(blank) / screen.hz;
    const auto step = static_cast<std::size_t>(since_s / screen.hold_s) % screen.order.size();
    flips.emplace_back(phase_s + since_s, screen.order[step] != 0);
  }
  return flips;
}

// The screen's light over time, walked through once: steps of the time constant's tenth at most.
class Light {
 public:
  Light(const ScreenTruth& screen, const std::vector<std::pair<double, bool>>& flips)
      : screen_(screen), flips_(flips) {}

  /// The mean from here on; times must rise.
  double mean(double from_s, double to_s) {
    run_to(from_s);
    sum_ = 0;
    run_to(to_s);
    return sum_ / (to_s - from_s);
  }

 private:
  void run_to(double end_s) {
    while (now_s_ < end_s) {
      const double change_s = next_ < flips_.size() ? flips_[next_].first + screen_.delay_s : end_s;
      if (change_s <= now_s_) {
        white_ = flips_[next_++].second;
        continue;
      }
      const double step_s = std::min({finest_s, end_s - now_s_, change_s - now_s_});
      const double after = white_ + (level_ - white_) * std::exp(-step_s / screen_.rise_s);
      sum_ += 0.5 * (level_ + after) * step_s;
      level_ = after;
      now_s_ += step_s;
    }
  }
  const ScreenTruth& screen_;
  const std::vector<std::pair<double, bool>>& flips_;
  std::size_t next_ = 0;
  double now_s_ = 0, level_ = 0, sum_ = 0, white_ = 0;
};

}  // namespace

BlinksSeen watch_blinks(const ScreenTruth& screen, const CameraTruth& camera, std::mt19937_64& random) {
  std::normal_distribution<double> unit;
  BlinksSeen seen;
  seen.flips = show(screen, 2 * before_s + camera.frames / camera.hz, random);
  Light light(screen, seen.flips);
  const double first_s = before_s + Uniform(0, 1 / camera.hz)(random);
  for (int n = 0; n < camera.frames; ++n) {
    const double begin_s = first_s + n / camera.hz;
    const double mean = light.mean(begin_s, begin_s + camera.exposure_s);
    const bool lost = Uniform()(random) < camera.lost;
    const double stamp_s = begin_s + 0.5 * camera.exposure_s + camera.jitter_s * unit(random);
    const double measured = camera.ground + mean + camera.noise * unit(random);
    if (lost) continue;
    seen.stamp_s.push_back(stamp_s);
    seen.light.push_back(measured);
  }
  return seen;
}

}  // namespace vam::oracle

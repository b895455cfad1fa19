// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/private/blinks.hpp"

#include <algorithm>

namespace vam::metrology {

Blinks::Blinks(const BlinkScan& scan) : scan_(scan), origin_s_(scan.lit_s.front().first) {
  double lit_s = 0;
  double twice_s2 = 0;
  double last_s = 0;
  for (const auto& [on_s, off_s] : scan.lit_s) {
    twice_s2 += lit_s * (on_s - origin_s_ - last_s);
    change_s_.push_back(on_s - origin_s_);
    lit_before_s_.push_back(lit_s);
    twice_before_s2_.push_back(twice_s2);
    const double seconds = off_s - on_s;
    twice_s2 += (lit_s + 0.5 * seconds) * seconds;
    lit_s += seconds;
    last_s = off_s - origin_s_;
    change_s_.push_back(last_s);
    lit_before_s_.push_back(lit_s);
    twice_before_s2_.push_back(twice_s2);
  }
}

double Blinks::twice_integral(double t_s) const {
  const auto after = std::upper_bound(change_s_.begin(), change_s_.end(), t_s) - change_s_.begin();
  if (after == 0) return 0;
  const auto i = static_cast<std::size_t>(after - 1);
  const double since_s = t_s - change_s_[i];
  const double light = i % 2 == 0 ? 1 : 0;
  return twice_before_s2_[i] + (lit_before_s_[i] + 0.5 * light * since_s) * since_s;
}

double Blinks::integral(double t_s) const {
  return (twice_integral(t_s + 0.5 * rise_s) - twice_integral(t_s - 0.5 * rise_s)) / rise_s;
}

std::vector<double> Blinks::lit_parts(double latency_s) const {
  std::vector<double> parts;
  parts.reserve(scan_.begin_s.size());
  for (const double begin_s : scan_.begin_s) {
    const double from_s = begin_s - origin_s_ - latency_s;
    parts.push_back((integral(from_s + scan_.exposure_s) - integral(from_s)) / scan_.exposure_s);
  }
  return parts;
}

Stretch unseen_stretch(const BlinkScan& scan, double latency_s) {
  constexpr double farthest_s = 0.3;  // frames of a screen are shorter
  std::vector<Stretch> seen{{latency_s - farthest_s, latency_s - farthest_s},
                            {latency_s + farthest_s, latency_s + farthest_s}};
  const auto meet = [&](double change_s) {
    auto begin =
        std::lower_bound(scan.begin_s.begin(), scan.begin_s.end(), change_s + latency_s - farthest_s - scan.exposure_s);
    for (; begin != scan.begin_s.end() && *begin < change_s + latency_s + farthest_s; ++begin) {
      seen.push_back({*begin - change_s, *begin - change_s + scan.exposure_s});
    }
  };
  for (const auto& [on_s, off_s] : scan.lit_s) {
    meet(on_s);
    meet(off_s);
  }
  std::sort(seen.begin(), seen.end(), [](const Stretch& a, const Stretch& b) { return a.from_s < b.from_s; });
  Stretch widest{latency_s, latency_s};
  double until_s = seen.front().to_s;
  for (const Stretch& one : seen) {
    const Stretch gap{until_s, one.from_s};
    if (gap.width_s() > widest.width_s() && gap.from_s < latency_s + rise_s && gap.to_s > latency_s - rise_s) {
      widest = gap;
    }
    until_s = std::max(until_s, one.to_s);
  }
  return widest;
}

}  // namespace vam::metrology

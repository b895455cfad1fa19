// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/private/blinks.hpp"

#include <algorithm>
#include <cmath>

namespace vam::metrology {

Blinks::Blinks(const BlinkScan& scan, double rise_s)
    : scan_(scan), rise_s_(rise_s), origin_s_(scan.lit_s.front().first) {
  double lit_s = 0;
  double level = 0;
  const auto change = [&](double at_s, double from) {  // from that light on
    const double since_s = at_s - origin_s_ - (change_s_.empty() ? 0 : change_s_.back());
    lit_s += from * since_s;
    level = from + (level - from) * std::exp(-since_s / rise_s);
    change_s_.push_back(at_s - origin_s_);
    lit_before_s_.push_back(lit_s);
    level_.push_back(level);
  };
  for (const auto& [on_s, off_s] : scan.lit_s) {
    change(on_s, 0);
    change(off_s, 1);
  }
}

double Blinks::integral(double t_s) const {
  const auto after = std::upper_bound(change_s_.begin(), change_s_.end(), t_s) - change_s_.begin();
  if (after == 0) return 0;
  const auto i = static_cast<std::size_t>(after - 1);
  const double since_s = t_s - change_s_[i];
  const double shown = i % 2 == 0 ? 1 : 0;
  const double rest = since_s < 40 * rise_s_ ? std::exp(-since_s / rise_s_) : 0;
  const double level = shown + (level_[i] - shown) * rest;
  return lit_before_s_[i] + shown * since_s - rise_s_ * level;
}

std::vector<double> Blinks::lit_parts(double latency_s) const {
  std::vector<double> parts;
  parts.reserve(scan_.begin_s.size());
  for (const double begin_s : scan_.begin_s) {
    const double from_s = begin_s - origin_s_ - (latency_s - rise_s_);
    parts.push_back((integral(from_s + scan_.exposure_s) - integral(from_s)) / scan_.exposure_s);
  }
  return parts;
}

Stretch unseen_stretch(const BlinkScan& scan, double latency_s, double rise_s) {
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
    if (gap.width_s() > widest.width_s() && gap.from_s < latency_s + std::max(unsure_s, 2 * rise_s) &&
        gap.to_s > latency_s - std::max(unsure_s, rise_s)) {
      widest = gap;
    }
    until_s = std::max(until_s, one.to_s);
  }
  return widest;
}

}  // namespace vam::metrology

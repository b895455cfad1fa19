#include "resin/gaps.hpp"

#include <algorithm>
#include <cmath>

namespace vam::resin {

double lowest_gap_dose(const Limits& limits, int slices) {
  const double lowest = limits.settled(limits.phi_min);
  const double highest = limits.settled(limits.phi_max);
  if (!(lowest < 1 && highest > 1)) return 1;
  const int nodes = limits.exposure == Exposure::continuous ? slices - 1 : slices;
  double least = 1;
  for (int d = 1; d <= nodes; ++d) {  // d nodes above the lower feature, nodes + 1 - d below the upper one
    const double fall = lowest + (1 - lowest) * std::pow(limits.q, d);
    const double power = std::pow(limits.q, nodes + 1 - d);
    const double rise = (1 - highest * (1 - power)) / power;
    least = std::min(least, std::max({fall, rise, 0.0}));
  }
  return least;
}

int narrowest_gap(const Limits& limits, double clear) {
  const double lowest = limits.settled(limits.phi_min);
  if (!(lowest < clear) || !(limits.settled(limits.phi_max) > 1)) return 0;
  int high = 2;
  while (lowest_gap_dose(limits, high) > clear) {
    if (high > 1 << 20) return 0;
    high *= 2;
  }
  int low = 1;  // not enough
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    (lowest_gap_dose(limits, middle) > clear ? low : high) = middle;
  }
  return low == 1 && limits.exposure == Exposure::layered && lowest_gap_dose(limits, 1) <= clear ? 1 : high;
}

double speed_limit_mm_h(const Process& process) {
  Process at_one = process;
  at_one.speed_mm_h = 1;
  const Limits limits = limits_of(at_one);  // Phi falls as 1 / speed
  return limits.settled(limits.phi_max);
}

}  // namespace vam::resin

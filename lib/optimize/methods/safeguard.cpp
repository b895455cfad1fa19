// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/methods/private/safeguard.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace vam::optimize {

PerSlice go_back(Iterate& now, const Iterate& before, PerSlice& loss, const PerSlice& loss_now) {
  PerSlice back = filled(loss.size(), 0.0F);
  bool any = false;
  for_slices(loss, [&](std::size_t s, std::size_t lane) {
    if (loss_now[s][lane] <= loss[s][lane]) {
      loss[s][lane] = loss_now[s][lane];
    } else {
      back[s][lane] = 1.0F;
      any = true;
    }
  });
  if (any) {
    restore(now.g, before.g, back);
    restore(now.dose, before.dose, back);
  }
  return back;
}

PerSlice pooled(PerSlice values, const light::Operator& light) {
  if (!light.couples_slices()) return values;
  double sum = 0;
  for (const auto& lane : values) {
    for (const float v : lane) sum += static_cast<double>(v);
  }
  return filled(values.size(), static_cast<float>(sum));
}

PerSlice largest_pooled(PerSlice values, const light::Operator& light) {
  return light.couples_slices() ? largest_of_all(std::move(values)) : values;
}

bool clip_above(std::vector<Slab>& g, float peak) {
  const PerSlice brightest = largest(g);
  const auto over = [&](const auto& lane) {
    return std::any_of(lane.begin(), lane.end(), [&](float v) { return v > peak; });
  };
  if (std::none_of(brightest.begin(), brightest.end(), over)) return false;
  for_values(g, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) g[s].values[i] = std::min(g[s].values[i], peak);
  });
  return true;
}

void enter_bounds(const Problem& problem, const light::Operator& light, float peak, Iterate& iterate) {
  if (clip_above(iterate.g, peak)) find_dose(problem, light, iterate);
}

float largest_light(const MethodOptions& options, const light::Operator& light) {
  if (options.max_intensity <= 0) return std::numeric_limits<float>::max();
  return static_cast<float>(options.max_intensity * light.row_angle_rad());
}

}  // namespace vam::optimize

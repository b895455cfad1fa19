// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/line_ends.hpp"

#include <algorithm>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam::metrology {

namespace {

enum class Side { bright = 1, dark = -1 };

// Is the ray beyond everything near the other end of its line by `least`?
bool beyond(const std::vector<Image>& sinograms, int t, int angle, int k, int rows, float least, Side side) {
  constexpr int columns = 2;
  const auto sign = static_cast<float>(side);
  const int other = opposite(sinograms[k], angle);
  const int mirror = sinograms[k].width - 1 - t;
  const float limit = sign * sinograms[k](t, angle) - least;
  for (int j = std::max(0, k - rows); j <= std::min(count_of(sinograms) - 1, k + rows); ++j) {
    const float* row = sinograms[j].row(other);
    const int last = std::min(sinograms.front().width - 1, mirror + columns);
    for (int i = std::max(0, mirror - columns); i <= last; ++i) {
      if (sign * row[i] >= limit) return false;
    }
  }
  return true;
}

RayMask rays_beyond(const std::vector<Image>& sinograms, std::span<const int> rows, int angle, float least, Side side) {
  const int width = sinograms.front().width;
  const auto sign = static_cast<float>(side);
  RayMask mask(sinograms.size() * width, 0);
  bool any = false;
  for (int k = 0; k < count_of(sinograms); ++k) {
    const Image& s = sinograms[k];
    const float* near = s.row(angle);
    const float* far = s.row(opposite(s, angle)) + width - 1;
    for (int t = 0; t < width; ++t) {
      if (sign * (near[t] - far[-t]) <= least || !beyond(sinograms, t, angle, k, rows[k], least, side)) continue;
      mask[product(k, width) + t] = 1;
      any = true;
    }
  }
  return any ? mask : RayMask{};
}

// Excess of a ray over the views before and after.
float passing(const Image& s, int t, int angle) {
  constexpr int views = 4;
  const int n = s.height;
  return s(t, angle) - 0.5F * (s(t, (angle + n - views) % n) + s(t, (angle + views) % n));
}

// Keeps the rays that dip where their other end does not change.
void keep_dips(const std::vector<Image>& sinograms, int angle, float least, RayMask& mask) {
  const int width = sinograms.front().width;
  for (int k = 0; k < count_of(sinograms); ++k) {
    const Image& s = sinograms[k];
    for (int t = 0; t < width; ++t) {
      char& marked = mask[product(k, width) + t];
      if (marked == 0) continue;
      const float here = passing(s, t, angle);
      const float there = passing(s, width - 1 - t, opposite(s, angle));
      if (here > -least || 2 * std::abs(there) > std::abs(here)) marked = 0;
    }
  }
}

}  // namespace

RayMask bright_rays(const std::vector<Image>& sinograms, std::span<const int> rows, int angle, float least) {
  return rays_beyond(sinograms, rows, angle, least, Side::bright);
}

void restore_dark_rays(std::vector<Image>& sinograms, std::span<const int> rows, float least) {
  constexpr int around = 3;
  const int width = sinograms.front().width;
  const auto heights = count_of(sinograms);
  std::vector<RayMask> marked(sinograms.front().height);
  parallel_for(count_of(marked), [&](int a) {
    marked[a] = rays_beyond(sinograms, rows, a, least, Side::dark);
    if (marked[a].empty()) return;
    keep_dips(sinograms, a, least, marked[a]);
    marked[a] = grown(marked[a], width, heights, around);
  });
  choose_ends(sinograms, marked, [](float own, float other) { return std::max(own, other); });
}

}  // namespace vam::metrology

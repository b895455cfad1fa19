// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/bubbles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/stats/median.hpp"
#include "base/stats/range.hpp"
#include "metrology/ost/private/body_paths.hpp"
#include "metrology/ost/private/hidden_rays.hpp"
#include "metrology/ost/private/one_density_body.hpp"
#include "metrology/ost/private/specks.hpp"

namespace vam::metrology {

namespace {

// Lines that look different from their two ends, and which of the ends is wrong.

// Sinograms: one a height, all of the same columns and of an even number of angles, four at least; `rows` has one
// number a height.

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

/// Rays of an angle that are brighter by `least` than the other end of their line and all near there: within two
/// columns and `rows[k]` heights. Empty: none.
RayMask bright_rays(const std::vector<Image>& sinograms, std::span<const int> rows, int angle, float least) {
  return rays_beyond(sinograms, rows, angle, least, Side::bright);
}

/// Gives rays that dirt hides for a few views, and those within 3 pixels of them, the brighter value of both ends of
/// their line: rays darker by `least` than the other end and all near there, and than the mean of the fourth angles
/// before and after, from which the other end does not differ by half as much. What passes the other end is a bubble
/// there.
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

// Standard deviation of the differences between the ends of lines, of a part of all.
double typical_difference(const std::vector<Image>& sinograms) {
  std::vector<float> differences;
  for (std::size_t k = 0; k < sinograms.size(); k += 3) {
    const Image& s = sinograms[k];
    for (int a = 0; a < s.height / 2; a += 5) {
      for (int t = 0; t < s.width; t += 2) {
        differences.push_back(s(t, a) - s(s.width - 1 - t, opposite(s, a)));
      }
    }
  }
  return differences.empty() ? 0.0 : stats::robust_sigma(std::move(differences));
}

float brightest(const std::vector<Image>& sinograms) {
  std::vector<float> most(sinograms.size());
  parallel_for(count_of(sinograms), [&](int k) { most[k] = stats::range_of(sinograms[k].values).second; });
  return std::max(0.0F, *std::max_element(most.begin(), most.end()));
}

/// Noise of a ray and the contrast that a bubble must have beside it.
struct Contrast {
  float noise;
  float share;
  [[nodiscard]] float least(float sigmas) const { return sigmas * noise + share; }
};

Contrast bubble_contrast(const std::vector<Image>& sinograms) {
  constexpr float part = 0.03F;
  const auto noise = static_cast<float>(typical_difference(sinograms) / std::sqrt(2.0));
  return {noise, part * brightest(sinograms)};
}

// Means of 3 x 3 rays of a view: bubbles are wider.
std::vector<Image> smoothed(const std::vector<Image>& sinograms) {
  const auto heights = count_of(sinograms);
  std::vector<Image> out(sinograms.size());
  parallel_for(heights, [&](int k) {
    const Image& below = sinograms[std::max(0, k - 1)];
    const Image& above = sinograms[std::min(heights - 1, k + 1)];
    const Image& s = sinograms[k];
    out[k] = Image(s.width, s.height);
    std::vector<float> sum(s.width);
    for (int a = 0; a < s.height; ++a) {
      for (int t = 0; t < s.width; ++t) sum[t] = (below(t, a) + s(t, a) + above(t, a)) / 9;
      for (int t = 0; t < s.width; ++t) {
        out[k](t, a) = sum[std::max(0, t - 1)] + sum[t] + sum[std::min(s.width - 1, t + 1)];
      }
    }
  });
  return out;
}

// Rays near marked ones, a few views before or after included: what lies before a brighter bubble is not marked.
std::vector<RayMask> surroundings(const std::vector<RayMask>& marked, int width, int heights) {
  constexpr int pixels = 3;
  constexpr int views = 4;
  const auto angles = count_of(marked);
  std::vector<RayMask> near(marked.size());
  parallel_for(angles, [&](int a) {
    RayMask all;
    for (int b = a - views; b <= a + views; ++b) mark_too(marked[(b + angles) % angles], all);
    if (!all.empty()) near[a] = grown(all, width, heights, pixels);
  });
  return near;
}

// The rays of these lines from their other ends.
std::vector<RayMask> mirrored(const std::vector<RayMask>& rays, int width) {
  const auto angles = count_of(rays);
  std::vector<RayMask> out(rays.size());
  parallel_for(angles, [&](int a) { out[a] = other_ends(rays[(a + angles / 2) % angles], width); });
  return out;
}

void add(const std::vector<RayMask>& more, std::vector<RayMask>& masks) {
  for (std::size_t a = 0; a < masks.size(); ++a) mark_too(more[a], masks[a]);
}

// Rays whose line is near a bubble, or hidden by a speck, at both ends.
std::vector<RayMask> suspect_rays(const std::vector<RayMask>& marked, const RayMask& specks, int width, int heights) {
  std::vector<RayMask> suspect = surroundings(marked, width, heights);
  if (share_of(specks) > 0) {
    propagate_mask(specks, width, suspect);
    add(std::vector<RayMask>(marked.size(), specks), suspect);
  }
  const std::vector<RayMask> far = mirrored(suspect, width);
  for (std::size_t a = 0; a < far.size(); ++a) keep_marked(far[a], suspect[a]);
  return suspect;
}

}  // namespace

double remove_bubbles(const ClimbingRays& rays, const model::Grid& grid, const RayMask& specks,
                      std::vector<Image>& sinograms, std::span<const int> rows) {
  const int width = sinograms.front().width;
  const int angles = sinograms.front().height;
  const auto heights = count_of(sinograms);
  if (brightest(sinograms) <= 0) return 0;  // beside the print
  const Contrast of_rays = bubble_contrast(sinograms);
  restore_dark_rays(sinograms, rows, of_rays.least(6));
  const std::vector<Image> smooth = smoothed(sinograms);
  const float least = bubble_contrast(smooth).least(6);
  std::vector<RayMask> marked(angles);
  parallel_for(angles, [&](int a) {
    marked[a] = bright_rays(smooth, rows, a, least);
    if (!marked[a].empty()) marked[a] = grown(marked[a], width, heights, 3);
  });
  std::ptrdiff_t count = 0;
  for (const RayMask& mask : marked) count += std::count(mask.begin(), mask.end(), char{1});
  const double share = static_cast<double>(count) / (static_cast<double>(width) * angles * heights);
  if (count == 0 || share > most_bubbles) return share;
  choose_ends(sinograms, marked, [](float own, float other) { return std::min(own, other); });
  std::vector<RayMask> hidden = suspect_rays(marked, specks, width, heights);
  const std::vector<Image> seen = sinograms;
  constexpr int rounds = 2;                                 // restored rays show the bodies better
  const float nearest = of_rays.noise + 3 * of_rays.share;  // nearer to the bodies a ray says more than they do
  float farthest = std::numeric_limits<float>::infinity();
  for (int round = 0; round < rounds; ++round) {
    const BodyPaths bodies(rays, one_density_body(rays, grid, sinograms, 0.5F * of_rays.least(6)));
    if (round == 0) {
      // Bubbles are seldom alike at both ends of a line: more rays than this are bodies of another density. Twice the
      // contrast, as the bodies are known to a few per cent.
      if (const auto above = rays_above(bodies, smoothed(seen), hidden, count / 4, 2 * least)) {
        add(*above, hidden);
        add(mirrored(*above, width), hidden);
        farthest = of_rays.least(6);  // rays that differ by more are bubbles that were not seen
      }
    }
    limit_to_bodies(bodies, hidden, nearest, farthest, seen, sinograms);
  }
  return share;
}

}  // namespace vam::metrology

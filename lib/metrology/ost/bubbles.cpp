#include "metrology/ost/private/bubbles.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "base/per_slice.hpp"
#include "base/stats/median.hpp"
#include "metrology/ost/private/ray_mask.hpp"
#include "tomo/fbp.hpp"

namespace vam::metrology {

namespace {

constexpr double sigmas_per_median = 1 / 0.6745;  // of |normal|

// Median of |value| over a part of all rays, of those that are not 0: empty rays of ideal views are.
double typical_difference(const std::vector<Image>& sinograms) {
  std::vector<float> differences;
  for (std::size_t k = 0; k < sinograms.size(); k += 3) {
    const Image& s = sinograms[k];
    for (int a = 0; a < s.height / 2; a += 5) {
      for (int t = 0; t < s.width; t += 2) {
        differences.push_back(std::abs(s(t, a) - s(s.width - 1 - t, opposite(s, a))));
      }
    }
  }
  return differences.empty() ? 0.0 : stats::median(differences);
}

// Largest value near the other end of a line.
float brightest_near(const std::vector<Image>& sinograms, int t, int angle, int k, int rows) {
  constexpr int columns = 2;
  float most = -1e30F;
  for (int j = std::max(0, k - rows); j <= std::min(count_of(sinograms) - 1, k + rows); ++j) {
    const float* row = sinograms[j].row(angle);
    const int last = std::min(sinograms.front().width - 1, t + columns);
    for (int i = std::max(0, t - columns); i <= last; ++i) most = std::max(most, row[i]);
  }
  return most;
}

// What a ray must be brighter by than the other end of its line: above the noise and a share of the contrast.
float bubble_contrast(const std::vector<Image>& sinograms) {
  float most = 0;
  for (const Image& s : sinograms) most = std::max(most, *std::max_element(s.values.begin(), s.values.end()));
  const double noise = typical_difference(sinograms) * sigmas_per_median / std::sqrt(2.0);
  return static_cast<float>(6 * noise + 0.03 * most);
}

// Rays of an angle that are brighter than the other end of their line and all near there. Empty: none.
RayMask bright_rays(const std::vector<Image>& sinograms, std::span<const int> rows, int angle, float least) {
  const int width = sinograms.front().width;
  RayMask mask(sinograms.size() * width, 0);
  bool any = false;
  for (int k = 0; k < count_of(sinograms); ++k) {
    const Image& s = sinograms[k];
    const int other = opposite(s, angle);
    const float* near = s.row(angle);
    const float* far = s.row(other) + width - 1;
    for (int t = 0; t < width; ++t) {
      if (near[t] - far[-t] <= least) continue;
      if (near[t] - brightest_near(sinograms, width - 1 - t, other, k, rows[k]) <= least) continue;
      mask[product(k, width) + t] = 1;
      any = true;
    }
  }
  return any ? mask : RayMask{};
}

// Gives marked rays the value of the darker end of their line. marked: one mask an angle.
void take_darker_ends(std::vector<Image>& sinograms, const std::vector<RayMask>& marked) {
  parallel_for(count_of(sinograms), [&](int k) {
    Image& s = sinograms[k];
    const Image before = s;
    for (int a = 0; a < s.height; ++a) {
      if (marked[a].empty()) continue;
      const char* row = marked[a].data() + std::ptrdiff_t{k} * s.width;
      for (int t = 0; t < s.width; ++t) {
        if (row[t] != 0) s(t, a) = std::min(before(t, a), before(s.width - 1 - t, opposite(s, a)));
      }
    }
  });
}

// Rays near marked ones, a few views before or after included: what lies before a brighter bubble is not marked.
std::vector<RayMask> surroundings(const std::vector<RayMask>& marked, int width, int heights) {
  constexpr int pixels = 3;
  constexpr int views = 4;
  const auto angles = count_of(marked);
  std::vector<RayMask> near(marked.size());
  parallel_for(angles, [&](int a) {
    RayMask all;
    for (int b = a - views; b <= a + views; ++b) {
      const RayMask& other = marked[(b + angles) % angles];
      if (other.empty()) continue;
      all.resize(other.size(), 0);
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<char>(all[i] | other[i]);
    }
    if (!all.empty()) near[a] = grown(all, width, heights, pixels);
  });
  return near;
}

// Rays whose line is near bubbles at either end.
std::vector<RayMask> suspect_rays(const std::vector<RayMask>& marked, int width, int heights) {
  const std::vector<RayMask> near = surroundings(marked, width, heights);
  const auto angles = count_of(near);
  std::vector<RayMask> suspect(near.size());
  parallel_for(angles, [&](int a) {
    const RayMask& far = near[(a + angles / 2) % angles];
    if (near[a].empty() || far.empty()) return;
    suspect[a].resize(far.size(), 0);
    for (int k = 0; k < heights; ++k) {
      for (int t = 0; t < width; ++t) {
        const std::size_t i = product(k, width) + t;
        suspect[a][i] = static_cast<char>(near[a][i] & far[product(k, width) + width - 1 - t]);
      }
    }
  });
  return suspect;
}

// Suspect rays of one height are at most what lies between the rays of that column before and after them.
void bridge(Image& s, const std::vector<RayMask>& suspect, int k) {
  const auto is_suspect = [&](int t, int a) {
    const RayMask& mask = suspect[a % s.height];
    return !mask.empty() && mask[product(k, s.width) + t] != 0;
  };
  for (int t = 0; t < s.width; ++t) {
    int first = 0;
    while (first < s.height && is_suspect(t, first)) ++first;
    int before = first;  // the last that is not suspect
    for (int a = first + 1; a <= first + s.height && first < s.height; ++a) {
      if (is_suspect(t, a)) continue;
      const float low = s(t, before % s.height);
      const float high = s(t, a % s.height);
      for (int b = before + 1; b < a; ++b) {
        const float part = static_cast<float>(b - before) / static_cast<float>(a - before);
        s(t, b % s.height) = std::min(s(t, b % s.height), low + part * (high - low));
      }
      before = a;
    }
  }
}

// The volume of these rays without its faint values, most of which are streaks.
std::vector<Slab> bodies_of(const tomo::ParallelGeometry& geometry, std::vector<Slab> sinograms) {
  constexpr float least = 0.05F;  // of the density of the bodies
  std::vector<Slab> images = slabs(sinograms.size(), geometry.nx, geometry.ny);
  tomo::fbp(geometry, sinograms, images);
  std::vector<float> some;
  for (const Slab& slab : images) {
    for (std::size_t i = 0; i < slab.values.size(); i += 5) {
      if (slab.values[i] > 0) some.push_back(slab.values[i]);
    }
  }
  if (some.empty()) return images;
  const auto high = some.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(some.size()));
  std::nth_element(some.begin(), high, some.end());
  const float level = least * *high;
  for (Slab& slab : images) {
    for (float& v : slab.values) v = v < level ? 0.0F : v;
  }
  return images;
}

// Suspect rays that are brighter than the bodies in `estimate` get their projection.
void limit_by_bodies(const tomo::ParallelGeometry& geometry, const std::vector<Image>& estimate,
                     const std::vector<RayMask>& suspect, float least, std::vector<Image>& sinograms) {
  const std::vector<Slab> bodies = bodies_of(geometry, packed(estimate, geometry.columns, geometry.angles));
  std::vector<Slab> projected = slabs(bodies.size(), geometry.columns, geometry.angles);
  tomo::forward(geometry, bodies, projected);
  parallel_for(count_of(sinograms), [&](int k) {
    Image& s = sinograms[k];
    for (int a = 0; a < s.height; ++a) {
      if (suspect[a].empty()) continue;
      for (int t = 0; t < s.width; ++t) {
        const float body = projected[k / lanes].at(t, a)[k % lanes];
        if (suspect[a][product(k, s.width) + t] != 0 && s(t, a) > body + least) s(t, a) = body;
      }
    }
  });
}

}  // namespace

double remove_bubbles(const tomo::ParallelGeometry& geometry, std::vector<Image>& sinograms,
                      std::span<const int> rows) {
  const int width = sinograms.front().width;
  const int angles = sinograms.front().height;
  const auto heights = count_of(sinograms);
  const float least = bubble_contrast(sinograms);
  std::vector<RayMask> marked(angles);
  parallel_for(angles, [&](int a) {
    marked[a] = bright_rays(sinograms, rows, a, least);
    if (!marked[a].empty()) marked[a] = grown(marked[a], width, heights, 3);
  });
  std::ptrdiff_t count = 0;
  for (const RayMask& mask : marked) count += std::count(mask.begin(), mask.end(), char{1});
  const double share = static_cast<double>(count) / (static_cast<double>(width) * angles * heights);
  if (count == 0 || share > most_bubbles) return share;
  take_darker_ends(sinograms, marked);
  const std::vector<RayMask> suspect = suspect_rays(marked, width, heights);
  std::vector<Image> estimate = sinograms;
  parallel_for(heights, [&](int k) { bridge(estimate[k], suspect, k); });
  limit_by_bodies(geometry, estimate, suspect, least, sinograms);
  return share;
}

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/bubbles.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "base/stats/median.hpp"
#include "metrology/ost/private/body_paths.hpp"
#include "metrology/ost/private/hidden_rays.hpp"
#include "metrology/ost/private/line_ends.hpp"
#include "metrology/ost/private/one_density_body.hpp"
#include "metrology/ost/private/ray_mask.hpp"

namespace vam::metrology {

namespace {

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

float brightest(const std::vector<Image>& sinograms) {
  float most = 0;
  for (const Image& s : sinograms) most = std::max(most, *std::max_element(s.values.begin(), s.values.end()));
  return most;
}

// What a ray must be brighter by than the other end of its line: above the noise and a share of the contrast.
float bubble_contrast(const std::vector<Image>& sinograms) {
  const float most = brightest(sinograms);
  const double noise = typical_difference(sinograms) * stats::sigmas_per_median / std::sqrt(2.0);
  return static_cast<float>(6 * noise + 0.03 * most);
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

// The rays of these lines from their other ends.
std::vector<RayMask> mirrored(const std::vector<RayMask>& rays, int width) {
  const auto angles = count_of(rays);
  std::vector<RayMask> out(rays.size());
  parallel_for(angles, [&](int a) {
    out[a] = rays[(a + angles / 2) % angles];
    for (auto row = out[a].begin(); row != out[a].end(); row += width) std::reverse(row, row + width);
  });
  return out;
}

// Rays whose line is near bubbles at both ends.
std::vector<RayMask> suspect_rays(const std::vector<RayMask>& marked, int width, int heights) {
  std::vector<RayMask> suspect = surroundings(marked, width, heights);
  const std::vector<RayMask> far = mirrored(suspect, width);
  for (std::size_t a = 0; a < far.size(); ++a) {
    if (far[a].empty()) suspect[a].clear();
    for (std::size_t i = 0; i < suspect[a].size(); ++i) suspect[a][i] = static_cast<char>(suspect[a][i] & far[a][i]);
  }
  return suspect;
}

void add(const std::vector<RayMask>& more, std::vector<RayMask>& masks) {
  for (std::size_t a = 0; a < masks.size(); ++a) {
    if (masks[a].empty()) masks[a].resize(more[a].size(), 0);
    for (std::size_t i = 0; i < more[a].size(); ++i) masks[a][i] = static_cast<char>(masks[a][i] | more[a][i]);
  }
}

}  // namespace

double remove_bubbles(const ClimbingRays& rays, const model::Grid& grid, std::vector<Image>& sinograms,
                      std::span<const int> rows) {
  const int width = sinograms.front().width;
  const int angles = sinograms.front().height;
  const auto heights = count_of(sinograms);
  if (brightest(sinograms) <= 0) return 0;  // beside the print
  const float least = bubble_contrast(sinograms);
  restore_dark_rays(sinograms, rows, least);
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
  std::vector<RayMask> hidden = suspect_rays(marked, width, heights);
  const std::vector<Image> seen = sinograms;
  constexpr int rounds = 2;  // restored rays show the bodies better
  for (int round = 0; round < rounds; ++round) {
    const BodyPaths bodies(rays, one_density_body(rays, grid, sinograms, 0.5F * least));
    if (round == 0) {
      // Bubbles are seldom alike at both ends of a line: more rays than this are bodies of another density. Twice the
      // contrast, as the bodies are known to a few per cent.
      const std::vector<RayMask> above = rays_above(bodies, seen, hidden, count / 4, 2 * least);
      add(above, hidden);
      add(mirrored(above, width), hidden);
    }
    limit_to_bodies(bodies, hidden, least, seen, sinograms);
  }
  return share;
}

}  // namespace vam::metrology

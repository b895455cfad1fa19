// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/dirt.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.hpp"
#include "base/json.hpp"
#include "base/parallel.hpp"
#include "base/stats/median.hpp"
#include "metrology/ost/private/ray_mask.hpp"

namespace vam::metrology {

namespace {

// Mean over the angles: one row a height.
Image mean_over_angles(const std::vector<Image>& sinograms) {
  Image mean(sinograms.front().width, count_of(sinograms));
  parallel_for(mean.height, [&](int k) {
    const Image& sinogram = sinograms[k];
    float* out = mean.row(k);
    const float share = 1.0F / static_cast<float>(sinogram.height);
    for (int a = 0; a < sinogram.height; ++a) {
      const float* in = sinogram.row(a);
      for (int t = 0; t < mean.width; ++t) out[t] += share * in[t];
    }
  });
  return mean;
}

// What departs from the median of its row's neighbourhood, less the same on the other side of the axis: both the
// edges of a turning body and its faces drop out.
Image departures(const Image& mean) {
  constexpr int beside = 9;
  Image local(mean.width, mean.height);
  parallel_for(mean.height, [&](int k) {
    const float* in = mean.row(k);
    for (int t = 0; t < mean.width; ++t) {
      const int first = std::max(0, t - beside);
      const int last = std::min(mean.width, t + beside + 1);
      local(t, k) = in[t] - static_cast<float>(stats::median(std::vector<float>(in + first, in + last)));
    }
  });
  Image out(mean.width, mean.height);
  for (int k = 0; k < mean.height; ++k) {
    for (int t = 0; t < mean.width; ++t) {
      const float here = local(t, k);
      const float there = local(mean.width - 1 - t, k);
      out(t, k) = std::abs(here) > std::abs(there) ? std::abs(here - there) : 0.0F;
    }
  }
  return out;
}

// Does a column differ from the other end of its lines at a third of the angles, always with the same sign? What passes
// does so for less of a turn.
bool stays(const Image& s, int t, float least) {
  int above = 0;
  int below = 0;
  for (int a = 0; a < s.height; ++a) {
    const float difference = s(t, a) - s(s.width - 1 - t, opposite(s, a));
    above += difference > least ? 1 : 0;
    below += difference < -least ? 1 : 0;
  }
  return 3 * std::max(above, below) >= s.height;
}

}  // namespace

Dirt even_background(const Image& mean_view) {
  std::vector<float> sorted = mean_view.values;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  const std::size_t tenth = n / 10;
  if (tenth < 2) return {};
  const double range = sorted[n - 1 - n / 1000] - sorted.front();
  std::size_t best = 0;
  for (std::size_t i = 0; i + tenth <= n * 6 / 10; ++i) {
    if (sorted[i + tenth] - sorted[i] < sorted[best + tenth] - sorted[best]) best = i;
  }
  // A tenth of a normal distribution about its middle is a quarter of a deviation wide.
  const double sigma = std::max(4 * static_cast<double>(sorted[best + tenth] - sorted[best]), 1e-5 * range);
  double level = sorted[best + tenth / 2];
  constexpr double widest = 0.1;  // of the contrast
  const auto darker = std::lower_bound(sorted.begin(), sorted.end(), static_cast<float>(level - 4 * sigma));
  if (sigma > widest * range || darker - sorted.begin() > static_cast<std::ptrdiff_t>(n / 50)) return {};
  for (int round = 0; round < 3 && sigma > 0; ++round) {
    const auto low = std::lower_bound(sorted.begin(), sorted.end(), static_cast<float>(level - 1.5 * sigma));
    const auto high = std::upper_bound(low, sorted.end(), static_cast<float>(level + 1.5 * sigma));
    level = std::accumulate(low, high, 0.0) / static_cast<double>(high - low);
  }
  Dirt found;
  found.background = level;
  found.has_background = true;
  return found;
}

std::vector<char> speck_rays(const std::vector<Image>& sinograms) {
  const Image mean = mean_over_angles(sinograms);
  const double most = *std::max_element(mean.values.begin(), mean.values.end());
  RayMask marked(mean.size());
  if (most <= 0) return marked;  // beside the print, where rounding leaves the background a little above the light
  const Image departure = departures(mean);
  std::vector<float> some;
  for (std::size_t i = 0; i < departure.size(); i += 7) {
    if (departure.values[i] > 0) some.push_back(departure.values[i]);
  }
  const double noise = some.empty() ? 0.0 : stats::median(some) * stats::sigmas_per_median;
  const auto least = static_cast<float>(8 * noise + 0.02 * most);
  for (int k = 0; k < mean.height; ++k) {
    for (int t = 0; t < mean.width; ++t) {
      const std::size_t i = mean.index(t, k);
      marked[i] = departure.values[i] > least && stays(sinograms[k], t, 0.5F * least) ? 1 : 0;
    }
  }
  return grown(marked, mean.width, mean.height, 2);
}

double remove_specks(std::vector<Image>& sinograms) {
  const RayMask marked = speck_rays(sinograms);
  const auto count = std::count(marked.begin(), marked.end(), char{1});
  if (count == 0) return 0;
  parallel_for(count_of(sinograms), [&](int k) {
    Image& s = sinograms[k];
    const char* row = marked.data() + product(k, s.width);
    for (int t = 0; t < s.width; ++t) {
      const int mirror = s.width - 1 - t;
      if (row[t] == 0 || row[mirror] != 0) continue;
      for (int a = 0; a < s.height; ++a) s(t, a) = s(mirror, opposite(s, a));
    }
  });
  return static_cast<double>(count) / static_cast<double>(marked.size());
}

Json to_json(const Dirt& dirt) {
  Json json{{"flicker_percent", dirt.flicker_percent},
            {"speck_percent", dirt.speck_percent},
            {"bubble_percent", dirt.bubble_percent},
            {"bubbles_exceed_limit", dirt.bubbles_exceed_limit}};
  json["background"] = dirt.has_background ? Json(dirt.background) : Json();
  return json;
}

}  // namespace vam::metrology

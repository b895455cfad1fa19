#include "metrology/ost/dirt.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/index.hpp"
#include "base/json.hpp"
#include "base/parallel.hpp"
#include "base/stats/median.hpp"

namespace vam::metrology {

namespace {

constexpr double sigmas_per_median = 1 / 0.6745;  // of |normal|

int opposite(const Image& sinogram, int angle) { return (angle + sinogram.height / 2) % sinogram.height; }

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

using RayMask = std::vector<char>;  // [height][column] of one angle: 1 where marked

// Marked places and those at most `by` pixels beside them.
RayMask grown(const RayMask& marked, int width, int height, int by) {
  RayMask out(marked.size(), 0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (marked[product(y, width) + x] == 0) continue;
      for (int j = std::max(0, y - by); j <= std::min(height - 1, y + by); ++j) {
        char* row = out.data() + std::ptrdiff_t{j} * width;
        std::fill(row + std::max(0, x - by), row + std::min(width, x + by + 1), char{1});
      }
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

double remove_specks(std::vector<Image>& sinograms) {
  const Image mean = mean_over_angles(sinograms);
  const Image departure = departures(mean);
  std::vector<float> some;
  for (std::size_t i = 0; i < departure.size(); i += 7) {
    if (departure.values[i] > 0) some.push_back(departure.values[i]);
  }
  const double noise = some.empty() ? 0.0 : stats::median(some) * sigmas_per_median;
  const double most = *std::max_element(mean.values.begin(), mean.values.end());
  const auto least = static_cast<float>(8 * noise + 0.02 * most);
  RayMask marked(mean.size());
  for (int k = 0; k < mean.height; ++k) {
    for (int t = 0; t < mean.width; ++t) {
      const std::size_t i = mean.index(t, k);
      marked[i] = departure.values[i] > least && stays(sinograms[k], t, 0.5F * least) ? 1 : 0;
    }
  }
  marked = grown(marked, mean.width, mean.height, 2);
  const auto count = std::count(marked.begin(), marked.end(), char{1});
  if (count == 0) return 0;
  parallel_for(mean.height, [&](int k) {
    Image& s = sinograms[k];
    for (int t = 0; t < mean.width; ++t) {
      if (marked[mean.index(t, k)] == 0) continue;
      const int mirror = mean.width - 1 - t;
      if (marked[mean.index(mirror, k)] != 0) continue;
      for (int a = 0; a < s.height; ++a) s(t, a) = s(mirror, opposite(s, a));
    }
  });
  return static_cast<double>(count) / static_cast<double>(mean.size());
}

double remove_bubbles(std::vector<Image>& sinograms, std::span<const int> rows) {
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
  if (count > 0 && share <= most_bubbles) take_darker_ends(sinograms, marked);
  return share;
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/specks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/stats/median.hpp"

namespace vam::metrology {

namespace {

// An even number, so that each part has one that sees its lines from their other ends.
constexpr int parts = 8;
using PartMeans = std::array<Image, parts>;

// Means over equal parts of the turn: one row a height.
PartMeans part_means(const std::vector<Image>& sinograms) {
  const int angles = sinograms.front().height;
  PartMeans means;
  means.fill(Image(sinograms.front().width, count_of(sinograms)));
  parallel_for(count_of(sinograms), [&](int k) {
    for (int p = 0; p < parts; ++p) {
      const int first = p * angles / parts;
      const int last = (p + 1) * angles / parts;
      const float share = 1.0F / static_cast<float>(last - first);
      float* out = means[p].row(k);
      for (int a = first; a < last; ++a) {
        const float* in = sinograms[k].row(a);
        for (int t = 0; t < sinograms[k].width; ++t) out[t] += share * in[t];
      }
    }
  });
  return means;
}

float middle_of(std::array<float, parts> values) {
  std::sort(values.begin(), values.end());
  return 0.5F * (values[parts / 2 - 1] + values[parts / 2]);
}

/// Static light of a pixel over the turn: the median of the parts, so that what passes in up to three of them does not
/// count.
struct StaticComponent {
  Image mean;        // as symmetric about the axis as the means are
  Image difference;  // from the other ends of the lines
};

StaticComponent steady(const PartMeans& means) {
  const int width = means.front().width;
  const int heights = means.front().height;
  StaticComponent out{Image(width, heights), Image(width, heights)};
  parallel_for(heights, [&](int k) {
    for (int t = 0; t < width; ++t) {
      std::array<float, parts> here{};
      std::array<float, parts> difference{};
      for (int p = 0; p < parts; ++p) {
        here[p] = means[p](t, k);
        difference[p] = here[p] - means[(p + parts / 2) % parts](width - 1 - t, k);
      }
      out.mean(t, k) = middle_of(here);
      out.difference(t, k) = middle_of(difference);
    }
  });
  return out;
}

// Departure of a pixel from the median of its row's neighbourhood.
float departure(const Image& image, int t, int k) {
  constexpr int beside = 9;
  const float* row = image.row(k);
  const int first = std::max(0, t - beside);
  const int last = std::min(image.width, t + beside + 1);
  return row[t] - static_cast<float>(stats::median(std::vector<float>(row + first, row + last)));
}

// Departures of the differences between both ends of lines, in which the edges and faces of a turning body cancel.
// Those on the other side of the axis are the same with the other sign.
Image departures(const Image& difference) {
  Image out(difference.width, difference.height);
  parallel_for(out.height, [&](int k) {
    for (int t = out.width / 2; t < out.width; ++t) {
      out(t, k) = std::abs(departure(difference, t, k));
      out(out.width - 1 - t, k) = out(t, k);
    }
  });
  return out;
}

// Does a column differ from the other end of its lines at a third of the angles, always with the same sign? What passes
// does so for less of a turn.
bool is_static(const Image& s, int t, float least) {
  int above = 0;
  int below = 0;
  for (int a = 0; a < s.height; ++a) {
    const float difference = s(t, a) - s(s.width - 1 - t, opposite(s, a));
    above += difference > least ? 1 : 0;
    below += difference < -least ? 1 : 0;
  }
  return 3 * std::max(above, below) >= s.height;
}

// A speck on the axis shows its rims only, where the two ends of a line differ: marks what is between both.
void close_on_axis(RayMask& marked, int width, int heights) {
  constexpr int nearest = 3;  // columns from the axis
  const int middle = (width - 1) / 2;
  for (int k = 0; k < heights; ++k) {
    char* row = marked.data() + product(k, width);
    const auto is_rim = [&](int t) { return t >= 0 && (row[t] != 0 || row[width - 1 - t] != 0); };
    int t = middle;
    while (t > middle - nearest && !is_rim(t)) --t;
    if (!is_rim(t)) continue;
    while (is_rim(t - 1)) --t;
    std::fill(row + t, row + width - t, char{1});
  }
}

/// Estimate of a hidden ray from those around it in the same view, weighted by the inverse squares of their distances.
struct Tap {
  int column;
  int height;
  float weight;
};

// The next ray to either side, above and below whose line is seen from both of its ends.
std::vector<Tap> taps_around(const RayMask& hidden, int width, int heights, int column, int height) {
  constexpr std::array<std::array<int, 2>, 4> directions{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
  std::vector<Tap> taps;
  float sum = 0;
  for (const auto& direction : directions) {
    const int right = direction[0];
    const int up = direction[1];
    int n = 1;
    const auto x = [&] { return column + n * right; };
    const auto y = [&] { return height + n * up; };
    const auto inside = [&] { return x() >= 0 && x() < width && y() >= 0 && y() < heights; };
    while (inside() && hidden[product(y(), width) + x()] != 0) ++n;
    if (!inside()) continue;
    taps.push_back({x(), y(), 1.0F / static_cast<float>(n * n)});
    sum += taps.back().weight;
  }
  for (Tap& tap : taps) tap.weight /= sum;
  return taps;
}

// Rays of which both ends are hidden, by what is around them.
void fill(const RayMask& specks, std::vector<Image>& sinograms) {
  const int width = sinograms.front().width;
  const auto heights = count_of(sinograms);
  RayMask hidden = specks;
  keep_marked(other_ends(specks, width), hidden);
  parallel_for(heights, [&](int k) {
    for (int t = 0; t < width; ++t) {
      if (hidden[product(k, width) + t] == 0) continue;
      const auto taps = taps_around(hidden, width, heights, t, k);
      if (taps.empty()) continue;
      for (int a = 0; a < sinograms[k].height; ++a) {
        float sum = 0;
        for (const Tap& tap : taps) sum += tap.weight * sinograms[tap.height](tap.column, a);
        sinograms[k](t, a) = sum;
      }
    }
  });
}

}  // namespace

RayMask speck_rays(const std::vector<Image>& sinograms) {
  const StaticComponent views = steady(part_means(sinograms));
  const int width = views.mean.width;
  const double most = *std::max_element(views.mean.values.begin(), views.mean.values.end());
  RayMask marked(views.mean.size());
  if (most <= 0) return marked;  // beside the print, where rounding leaves the background a little above the light
  const Image departing = departures(views.difference);
  std::vector<float> some;
  for (std::size_t i = 0; i < departing.size(); i += 7) some.push_back(departing.values[i]);
  const double noise = stats::robust_sigma(std::move(some));
  const auto least = static_cast<float>(8 * noise + 0.02 * most);
  const auto departs_here = [&](int t, int k) {  // and not the other end of its lines
    return std::abs(departure(views.mean, t, k)) > std::abs(departure(views.mean, width - 1 - t, k));
  };
  for (int k = 0; k < departing.height; ++k) {
    for (int t = 0; t < width; ++t) {
      if (departing(t, k) <= least || !is_static(sinograms[k], t, 0.5F * least) || !departs_here(t, k)) continue;
      marked[departing.index(t, k)] = 1;
    }
  }
  close_on_axis(marked, width, departing.height);
  return grown(marked, width, departing.height, 2);
}

void replace_specks(const RayMask& specks, std::vector<Image>& sinograms) {
  parallel_for(count_of(sinograms), [&](int k) {
    Image& s = sinograms[k];
    const char* row = specks.data() + product(k, s.width);
    for (int t = 0; t < s.width; ++t) {
      const int mirror = s.width - 1 - t;
      if (row[t] == 0 || row[mirror] != 0) continue;
      for (int a = 0; a < s.height; ++a) s(t, a) = s(mirror, opposite(s, a));
    }
  });
  fill(specks, sinograms);
}

void propagate_mask(const RayMask& specks, int width, std::vector<RayMask>& marked) {
  const int heights = count_of(specks) / width;
  RayMask hidden = specks;
  mark_too(other_ends(specks, width), hidden);
  struct Ray {
    std::size_t index;
    std::vector<Tap> taps;
  };
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    const int at = static_cast<int>(i);
    if (hidden[i] != 0) rays.push_back({i, taps_around(hidden, width, heights, at % width, at / width)});
  }
  parallel_for(count_of(marked), [&](int a) {
    RayMask& mask = marked[a];
    if (mask.empty()) return;
    for (const Ray& ray : rays) {
      const auto is_marked = [&](const Tap& tap) { return mask[product(tap.height, width) + tap.column] != 0; };
      if (std::any_of(ray.taps.begin(), ray.taps.end(), is_marked)) mask[ray.index] = 1;
    }
  });
}

}  // namespace vam::metrology

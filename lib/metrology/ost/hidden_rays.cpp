// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/private/hidden_rays.hpp"

#include <algorithm>
#include <numeric>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"

namespace vam::metrology {

namespace {

constexpr int pitch = 4;        // of the columns that are looked at: bubbles are wider
constexpr int coarse_step = 4;  // along rays that are compared: its errors are small beside the contrast of a bubble
constexpr int fine_step = 2;    // along rays whose value is taken

bool is_in(const std::vector<RayMask>& masks, int angle, std::size_t i) {
  return !masks[angle].empty() && masks[angle][i] != 0;
}

/// Compares rays of one angle with the bodies.
class Comparison {
 public:
  Comparison(const BodyPaths& bodies, const std::vector<Image>& sinograms, int angle, float least)
      : bodies_(bodies), sinograms_(sinograms), angle_(angle), least_(least), passed_(sinograms.size()) {}

  // Rays of a column from the first to the last that can be too bright. False: there is none.
  bool look(int t) {
    const int heights = count_of(sinograms_);
    int first = 0;
    int last = heights - 1;
    while (first < heights && !may_exceed(t, first)) ++first;
    if (first == heights) return false;
    while (!may_exceed(t, last)) --last;
    first = std::max(first - 1, 0);
    last = std::min(last + 1, heights - 1);
    std::fill(passed_.begin(), passed_.end(), 1e30F);
    bodies_.along(t, angle_, first, coarse_step, std::span(passed_).subspan(first, last - first + 1));
    return true;
  }
  // Do this ray of the column and those around it?
  [[nodiscard]] bool exceeds(int t, int k) const {
    for (int j = k - 1; j <= k + 1; ++j) {
      if (value(t, j) <= passed_[j] + least_) return false;
    }
    return exceeds_beside(t - 1, k) && exceeds_beside(t + 1, k);
  }

 private:
  [[nodiscard]] float value(int t, int k) const { return sinograms_[k](t, angle_); }
  // Bubbles at both ends of a line are seen from either, one that is at one end makes that the brighter one.
  [[nodiscard]] bool may_exceed(int t, int k) const {
    const Image& s = sinograms_[k];
    const float far = 2 * angle_ < s.height ? 0.0F : s(s.width - 1 - t, opposite(s, angle_));
    return value(t, k) > std::max(far, 0.0F) + least_;
  }
  [[nodiscard]] bool exceeds_beside(int t, int k) const {
    float passed = 0;
    bodies_.along(t, angle_, k, coarse_step, std::span(&passed, 1));
    return value(t, k) > passed + least_;
  }

  const BodyPaths& bodies_;
  const std::vector<Image>& sinograms_;
  int angle_;
  float least_;
  std::vector<float> passed_;
};

// Paths of hidden rays, and of those next to them in angle, through bodies: one image an angle, columns x heights.
std::vector<Image> passed_by(const BodyPaths& bodies, const std::vector<RayMask>& hidden, int width, int heights) {
  const auto angles = count_of(hidden);
  std::vector<Image> passed(hidden.size());
  parallel_for(angles, [&](int a) {
    const int before = (a + angles - 1) % angles;
    const int after = (a + 1) % angles;
    if (hidden[a].empty() && hidden[before].empty() && hidden[after].empty()) return;
    passed[a] = Image(width, heights);
    std::vector<float> run(heights);
    for (int t = 0; t < width; ++t) {
      const auto needed = [&](int k) {
        const std::size_t i = product(k, width) + t;
        return is_in(hidden, a, i) || is_in(hidden, before, i) || is_in(hidden, after, i);
      };
      for (int k = 0; k < heights; ++k) {
        const int first = k;
        while (k < heights && needed(k)) ++k;
        if (k == first) continue;
        const auto out = std::span(run).first(k - first);
        bodies.along(t, a, first, fine_step, out);
        for (int j = first; j < k; ++j) passed[a](t, j) = out[j - first];
      }
    }
  });
  return passed;
}

}  // namespace

std::optional<std::vector<RayMask>> rays_above(const BodyPaths& bodies, const std::vector<Image>& sinograms,
                                               const std::vector<RayMask>& known, std::ptrdiff_t most, float least) {
  constexpr int around = pitch / 2 + 3;  // up to the next column that is looked at, and the rim of the bubble
  const auto heights = count_of(sinograms);
  const int width = sinograms.front().width;
  std::vector<RayMask> above(known.size());
  std::vector<std::ptrdiff_t> found(known.size());
  parallel_for(count_of(known), [&](int a) {
    Comparison rays(bodies, sinograms, a, least);
    RayMask mask(product(heights, width), 0);
    for (int t = 1; t + 1 < width; t += pitch) {
      if (!rays.look(t)) continue;
      for (int k = 1; k + 1 < heights; ++k) {
        const std::size_t i = product(k, width) + t;
        if (is_in(known, a, i) || !rays.exceeds(t, k)) continue;
        mask[i] = 1;
        found[a] += pitch;
      }
    }
    if (found[a] > 0) above[a] = grown(mask, width, heights, around);
  });
  if (std::accumulate(found.begin(), found.end(), std::ptrdiff_t{0}) > most) return std::nullopt;
  return above;
}

void limit_to_bodies(const BodyPaths& bodies, const std::vector<RayMask>& hidden, float least, float farthest,
                     const std::vector<Image>& seen, std::vector<Image>& sinograms) {
  const int width = seen.front().width;
  const auto passed = passed_by(bodies, hidden, width, count_of(seen));
  parallel_for(count_of(seen), [&](int k) {
    const Image& s = seen[k];
    Image& out = sinograms[k];
    out = s;
    const int n = s.height;
    for (int t = 0; t < width; ++t) {
      const std::size_t i = product(k, width) + t;
      const int mirror = width - 1 - t;
      const auto limit = [&](int a, float most) {
        const int b = opposite(s, a);
        if (is_in(hidden, b, product(k, width) + mirror)) {
          most = std::min(most, std::max(0.0F, s(mirror, b) + passed[a](t, k) - passed[b](mirror, k)));
        }
        if (s(t, a) > most + least) out(t, a) = most;
      };
      int first = 0;
      while (first < n && is_in(hidden, first, i)) ++first;
      for (int a = 0; a < n && first == n; ++a) limit(a, passed[a](t, k));
      int last = first;  // the last that is not hidden
      for (int a = first + 1; a <= first + n && first < n; ++a) {
        if (is_in(hidden, a % n, i)) continue;
        for (int b = last + 1; b < a; ++b) {
          const float low = std::min(s(t, last % n) - passed[last % n](t, k), farthest);
          const float high = std::min(s(t, a % n) - passed[a % n](t, k), farthest);
          const float part = static_cast<float>(b - last) / static_cast<float>(a - last);
          limit(b % n, std::max(0.0F, passed[b % n](t, k) + low + part * (high - low)));
        }
        last = a;
      }
    }
  });
}

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
// Levelling a profilometer's image.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/stats/median.hpp"
#include "base/text/text.hpp"
#include "metrology/compare/emboss.hpp"

namespace vam::metrology {

namespace {

struct BasePlane {
  double at_middle = 0;
  double per_column = 0;
  double per_row = 0;
};

// Otsu's threshold: the split into two classes with the largest variance between them [OTSU79].
double otsu(const std::vector<float>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  constexpr int bins = 512;
  std::array<double, bins> counts{};
  const double width = (*high - static_cast<double>(*low)) / bins;
  if (!(width > 0)) return *low;
  for (const float v : values) {
    const int bin = static_cast<int>((v - static_cast<double>(*low)) / width);
    ++counts[std::clamp(bin, 0, bins - 1)];
  }
  double all = 0;
  for (std::size_t b = 0; b < bins; ++b) all += counts[b] * static_cast<double>(b);
  const auto total = static_cast<double>(values.size());
  double below = 0;
  double below_sum = 0;
  double best = -1;
  std::size_t first = 0;  // the threshold is in the middle of the bins that do equally well
  std::size_t last = 0;
  for (std::size_t b = 0; b + 1 < bins; ++b) {
    below += counts[b];
    below_sum += counts[b] * static_cast<double>(b);
    if (below == 0 || below == total) continue;
    const double apart = below_sum / below - (all - below_sum) / (total - below);
    const double between = below * (total - below) * apart * apart;
    if (between > best * (1 + 1e-12)) {
      best = between;
      first = b;
    }
    if (between >= best * (1 - 1e-12)) last = b;
  }
  return *low + width * (0.5 * static_cast<double>(first + last) + 1);
}

/// Least squares over the pixels with a reading for which use(pixel, height) holds.
template <class Use>
BasePlane fit_plane(const Image& heights, const Use& use) {
  std::vector<double> rows;  // 1, x, y
  std::vector<double> used;
  for (int j = 0; j < heights.height; ++j) {
    for (int i = 0; i < heights.width; ++i) {
      const double h = heights(i, j);
      if (!std::isfinite(h) || !use(i, j, h)) continue;
      rows.insert(rows.end(), {1, i - 0.5 * (heights.width - 1), j - 0.5 * (heights.height - 1)});
      used.push_back(h);
    }
  }
  const std::vector<double> plane = stats::linear_fit(rows, 3, used);
  return {plane[0], plane[1], plane[2]};
}

double plane_at(const BasePlane& plane, const Image& image, int i, int j) {
  return plane.at_middle + plane.per_column * (i - 0.5 * (image.width - 1)) +
         plane.per_row * (j - 0.5 * (image.height - 1));
}

std::vector<float> readings(std::vector<float> heights) {
  std::erase_if(heights, [](float h) { return !std::isfinite(h); });
  return heights;
}

Image without(const BasePlane& plane, const Image& heights) {
  Image flat = heights;
  for (int j = 0; j < flat.height; ++j) {
    for (int i = 0; i < flat.width; ++i) flat(i, j) -= static_cast<float>(plane_at(plane, heights, i, j));
  }
  return flat;
}

// Gaps become the mean of their neighbours, from the rim inwards; what is deeper than `rounds` pixels becomes base.
void fill_gaps(Image& heights) {
  constexpr int rounds = 3;
  bool gaps = true;
  for (int round = 0; gaps && round < rounds; ++round) {
    gaps = false;
    const Image before = heights;
    for (int j = 0; j < heights.height; ++j) {
      for (int i = 0; i < heights.width; ++i) {
        if (std::isfinite(before(i, j))) continue;
        float sum = 0;
        int count = 0;
        for (int y = std::max(0, j - 1); y <= std::min(heights.height - 1, j + 1); ++y) {
          for (int x = std::max(0, i - 1); x <= std::min(heights.width - 1, i + 1); ++x) {
            if (!std::isfinite(before(x, y))) continue;
            sum += before(x, y);
            ++count;
          }
        }
        if (count > 0) heights(i, j) = sum / static_cast<float>(count);
        gaps = true;
      }
    }
  }
  for (float& height : heights.values) height = std::isfinite(height) ? height : 0.0F;
}

// The base without what is not of it: sides of the embossing below the threshold, dents, crumbs. Residuals beyond 2.5
// robust standard deviations of those below the limit do not count.
BasePlane trimmed_base(const Image& heights, BasePlane base, double limit) {
  constexpr int rounds = 8;
  for (int round = 0; round < rounds; ++round) {
    std::vector<float> residuals = readings(without(base, heights).values);
    std::erase_if(residuals, [&](float h) { return !(static_cast<double>(h) < limit); });
    if (residuals.empty()) return base;
    const double middle = stats::median(residuals);
    const double most = 2.5 * stats::robust_sigma(std::move(residuals), static_cast<float>(middle)) + 1e-7;
    base = fit_plane(
        heights, [&](int i, int j, double h) { return std::abs(h - plane_at(base, heights, i, j) - middle) <= most; });
  }
  return base;
}

}  // namespace

std::optional<Plateaus> plateaus(std::vector<float> heights) {
  heights = readings(std::move(heights));
  if (heights.empty()) return std::nullopt;
  const double limit = otsu(heights);
  std::vector<float> base;
  std::vector<float> above;
  for (const float h : heights) (h < limit ? base : above).push_back(h);
  if (base.empty() || above.empty()) return std::nullopt;
  const Plateaus found{stats::median(base), stats::median(above)};
  const double apart = found.top_mm - found.base_mm;
  const double spread = stats::robust_sigma(std::move(base), static_cast<float>(found.base_mm));
  if (!(apart > 4 * spread && apart > 1e-5)) return std::nullopt;
  return found;
}

Relief levelled(const Image& heights_mm, double pixel_mm) {
  const std::vector<float> values = readings(heights_mm.values);
  if (static_cast<double>(values.size()) < 0.1 * static_cast<double>(heights_mm.size())) {
    throw Error{Fault::data, "height image: only " + std::to_string(values.size()) + " of " +
                                 std::to_string(heights_mm.size()) + " pixels are readings"};
  }
  BasePlane base = fit_plane(heights_mm, [](int, int, double) { return true; });
  double limit = 0;
  for (int round = 0; round < 12; ++round) {
    limit = otsu(readings(without(base, heights_mm).values));
    base = fit_plane(heights_mm, [&](int i, int j, double h) { return h - plane_at(base, heights_mm, i, j) < limit; });
  }
  base = trimmed_base(heights_mm, base, limit);
  Relief relief;
  relief.heights_mm = without(base, heights_mm);
  relief.pixel_mm = pixel_mm;
  relief.tilt_deg = std::atan(std::hypot(base.per_column, base.per_row) / pixel_mm) * deg_per_rad;
  relief.measured = Image(heights_mm.width, heights_mm.height, 1.0F);
  for (std::size_t i = 0; i < heights_mm.size(); ++i) {
    if (!std::isfinite(heights_mm.values[i])) relief.measured.values[i] = 0;
  }
  const auto found = plateaus(relief.heights_mm.values);
  if (!found) throw Error{Fault::data, "height image: flat, no embossing above its base"};
  relief.plateau_mm = found->top_mm;
  fill_gaps(relief.heights_mm);
  return relief;
}

}  // namespace vam::metrology

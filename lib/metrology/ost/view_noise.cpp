// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/view_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/random.hpp"
#include "base/stats/curve_fit.hpp"
#include "base/stats/median.hpp"

namespace vam::metrology {

namespace {

constexpr std::size_t bins = 24;

struct Brightness {
  double low = 0;
  double high = 0;
};

Brightness brightness_of(std::span<const CameraView> views) {
  std::vector<float> some;
  for (const CameraView& view : views) {
    const std::size_t step = view.image.size() / 2000 + 1;
    for (std::size_t i = 0; i < view.image.size(); i += step) some.push_back(view.image.values[i]);
  }
  std::sort(some.begin(), some.end());
  return {static_cast<double>(some.front()), static_cast<double>(some[some.size() - 1 - some.size() / 1000])};
}

using Binned = std::array<std::vector<float>, bins>;

// Magnitudes of the second differences, by the mean of the nine pixels.
void add_differences(const Image& image, const Brightness& range, Binned& binned) {
  constexpr std::array<float, 3> kernel{1, -2, 1};
  const double width = std::max((range.high - range.low) / static_cast<double>(bins), 1e-30);
  for (int y = 1; y + 1 < image.height; ++y) {
    for (int x = 1; x + 1 < image.width; ++x) {
      float difference = 0;
      float mean = 0;
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) {
          const float value = image(x + i - 1, y + j - 1);
          difference += kernel[i] * kernel[j] * value;
          mean += value / 9;
        }
      }
      const double at = std::clamp((static_cast<double>(mean) - range.low) / width, 0.0, bins - 1.0);
      binned[static_cast<std::size_t>(at)].push_back(std::abs(difference));
    }
  }
}

}  // namespace

double ViewNoise::sigma(double value) const { return std::sqrt(std::max(0.0, floor + per_value * value)); }

ViewNoise view_noise(std::span<const CameraView> views) {
  constexpr std::size_t most_views = 24;
  constexpr std::size_t fewest = 300;  // pixels of a bin
  constexpr double gain = 36;          // of the variance: the kernel's sum of squares
  const Brightness range = brightness_of(views);
  Binned binned;
  const std::size_t step = views.size() / most_views + 1;
  for (std::size_t i = 0; i < views.size(); i += step) add_differences(views[i].image, range, binned);
  std::vector<double> rows;
  std::vector<double> ones;
  for (std::size_t b = 0; b < bins; ++b) {
    if (binned[b].size() < fewest) continue;
    const double variance = std::pow(stats::median(binned[b]) / 0.6745, 2) / gain;
    const double value = range.low + (static_cast<double>(b) + 0.5) * (range.high - range.low) / bins;
    const double relative = std::max(variance, 1e-12 * range.high * range.high);  // errors of variances are relative
    rows.insert(rows.end(), {1 / relative, value / relative});
    ones.push_back(variance / relative);
  }
  if (ones.size() < 2) return {};
  const std::vector<double> line = stats::linear_fit(rows, 2, ones);
  if (line[0] >= 0 && line[1] >= 0) return {line[0], line[1]};
  const std::size_t only = line[0] < 0 ? 1 : 0;
  std::vector<double> column;
  for (std::size_t i = only; i < rows.size(); i += 2) column.push_back(rows[i]);
  const double part = std::max(0.0, stats::linear_fit(column, 1, ones)[0]);
  return only == 0 ? ViewNoise{part, 0} : ViewNoise{0, part};
}

std::vector<CameraView> noise_views(std::span<const CameraView> views, const ViewNoise& noise, std::uint64_t seed) {
  std::vector<CameraView> drawn(views.size());
  parallel_for(count_of(views), [&](int i) {
    const Image& seen = views[i].image;
    drawn[i] = {Image(seen.width, seen.height), views[i].angle_deg};
    std::uint64_t state = scrambled(scrambled(seed) + static_cast<std::uint64_t>(i));
    for (std::size_t p = 0; p < seen.size(); p += 2) {  // two normal numbers at once [BM58]
      const double radius = std::sqrt(-2 * std::log(1 - unit_interval(state = scrambled(state))));
      const double angle = 2 * std::numbers::pi * unit_interval(state = scrambled(state));
      const auto put = [&](std::size_t at, double value) {
        if (at >= seen.size()) return;
        drawn[i].image.values[at] = static_cast<float>(value * noise.sigma(static_cast<double>(seen.values[at])));
      };
      put(p, radius * std::cos(angle));
      put(p + 1, radius * std::sin(angle));
    }
  });
  return drawn;
}

}  // namespace vam::metrology

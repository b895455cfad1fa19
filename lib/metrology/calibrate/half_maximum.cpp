// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/calibrate/private/half_maximum.hpp"

#include <algorithm>
#include <cmath>

#include "base/stats/line.hpp"
#include "base/stats/median.hpp"

namespace vam::metrology {

namespace {

// Ends of the profile, a tenth on either side.
std::vector<double> margins(const std::vector<double>& profile) {
  const auto tenth = static_cast<std::ptrdiff_t>(std::max<std::size_t>(profile.size() / 10, 2));
  std::vector<double> ends(profile.begin(), profile.begin() + tenth);
  ends.insert(ends.end(), profile.end() - tenth, profile.end());
  return ends;
}

struct Crossings {
  double begin = 0;
  double end = 0;
};

// The outermost crossings of a level, if it is crossed on both sides.
std::optional<Crossings> crossings(const std::vector<double>& profile, double level) {
  const std::size_t n = profile.size();
  std::size_t first = 0;
  while (first < n && profile[first] < level) ++first;
  std::size_t last = n;
  while (last > first && profile[last - 1] < level) --last;
  if (first == 0 || last == n || first == n) return std::nullopt;
  const auto between = [&](std::size_t below, std::size_t above) {
    const double part = (level - profile[below]) / (profile[above] - profile[below]);
    return static_cast<double>(below) + part * (static_cast<double>(above) - static_cast<double>(below));
  };
  return Crossings{between(first - 1, first), between(last, last - 1)};
}

// The height in the middle, by a parabola over two fifths of the width: right for flat and for round tops, and not
// lifted by noise as the largest sample is.
double top_of(const std::vector<double>& profile, const Crossings& at) {
  const double middle = 0.5 * (at.begin + at.end);
  const double reach = 0.2 * (at.end - at.begin);
  std::vector<double> squares, heights;
  const auto last = static_cast<std::size_t>(middle + reach);
  for (auto i = static_cast<std::size_t>(std::ceil(middle - reach)); i <= last; ++i) {
    squares.push_back(std::pow(static_cast<double>(i) - middle, 2));
    heights.push_back(profile[i]);
  }
  if (heights.size() < 4) return *std::max_element(profile.begin(), profile.end());
  return stats::straight_line(squares, heights).at(0);
}

// Centroid of the excess over the level, where it is connected to the samples between the crossings.
double centroid_above(const std::vector<double>& profile, const Crossings& at, double level) {
  auto first = static_cast<std::size_t>(std::ceil(at.begin));
  while (first > 0 && profile[first - 1] > level) --first;
  auto end = static_cast<std::size_t>(at.end) + 1;
  while (end < profile.size() && profile[end] > level) ++end;
  double sum = 0;
  double moment = 0;
  for (std::size_t i = first; i < end; ++i) {
    const double excess = std::max(profile[i] - level, 0.0);
    sum += excess;
    moment += excess * (static_cast<double>(i) - at.begin);
  }
  return at.begin + moment / sum;
}

}  // namespace

std::optional<Extent> half_maximum(const std::vector<double>& profile) {
  if (profile.size() < 8) return std::nullopt;
  const std::vector<double> ends = margins(profile);
  const double ground = stats::median(ends);
  double noise = 0;
  for (const double value : ends) noise += std::abs(value - ground) / static_cast<double>(ends.size());
  const double peak = *std::max_element(profile.begin(), profile.end());
  if (!(peak - ground > 6 * noise) || peak <= ground) return std::nullopt;
  const auto rough = crossings(profile, ground + 0.5 * (peak - ground));
  if (!rough) return std::nullopt;
  const double height = top_of(profile, *rough) - ground;
  const double level = ground + 0.5 * height;
  const auto exact = crossings(profile, level);
  if (!exact || height <= 0) return std::nullopt;
  return Extent{exact->begin, exact->end, height, centroid_above(profile, *exact, ground + 0.25 * height)};
}

std::vector<double> column_profile(const Image& image, int first, int last) {
  std::vector<double> profile(image.width);
  for (int y = first; y < last; ++y) {
    for (int x = 0; x < image.width; ++x) profile[x] += image(x, y);
  }
  for (double& value : profile) value /= last - first;
  return profile;
}

}  // namespace vam::metrology

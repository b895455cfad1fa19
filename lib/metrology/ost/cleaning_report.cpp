// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/cleaning_report.hpp"

#include <algorithm>
#include <numeric>

#include "base/text/json.hpp"

namespace vam::metrology {

CleaningReport even_background(const Image& mean_view) {
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
  CleaningReport found;
  found.background = level;
  found.has_background = true;
  return found;
}

Json to_json(const CleaningReport& dirt) {
  Json json{{"flicker_percent", dirt.flicker_percent},
            {"speck_percent", dirt.speck_percent},
            {"bubble_percent", dirt.bubble_percent},
            {"bubbles_exceed_limit", dirt.bubbles_exceed_limit}};
  json["background"] = dirt.has_background ? Json(dirt.background) : Json();
  return json;
}

}  // namespace vam::metrology

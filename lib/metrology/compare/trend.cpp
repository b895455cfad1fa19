// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/trend.hpp"

#include <cmath>
#include <numeric>
#include <vector>

#include "base/index.hpp"
#include "base/stats/distributions.hpp"
#include "base/stats/line.hpp"
#include "base/text/json.hpp"

namespace vam::metrology {

Trend trend_of(std::span<const double> values, std::span<const double> uncertainties) {
  std::vector<double> places(values.size());
  std::iota(places.begin(), places.end(), 0.0);
  const stats::Line line = stats::straight_line(places, values);
  const auto n = static_cast<double>(values.size());
  double squares = 0;
  double rest = 0;
  Trend found;
  for (std::size_t i = 0; i < values.size(); ++i) {
    squares += std::pow(values[i] - line.mean_y, 2);
    rest += std::pow(values[i] - line.at(places[i]), 2);
    found.uncertainty += std::pow(uncertainties[i], 2) / n;
  }
  found.prints = count_of(values);
  found.mean = line.mean_y;
  found.spread = std::sqrt(squares / (n - 1));
  found.drift = line.slope;
  found.drift_sigma = std::sqrt(rest / (n - 2) / line.spread);
  if (found.drift_sigma > 0) found.p = stats::student_tail(found.drift / found.drift_sigma, n - 2);
  if (found.drift_sigma == 0 && found.drift != 0) found.p = 0;
  found.last = values.back();
  found.uncertainty = std::sqrt(found.uncertainty);
  return found;
}

Json to_json(const Trend& trend) {
  return {{"mean", trend.mean},
          {"spread", trend.spread},
          {"drift", trend.drift},
          {"drift_sigma", trend.drift_sigma},
          {"drift_p", trend.p},
          {"last", trend.last},
          {"uncertainty", trend.uncertainty}};
}

}  // namespace vam::metrology

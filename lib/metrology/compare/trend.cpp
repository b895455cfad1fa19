// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/trend.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "base/stats/student.hpp"
#include "base/text/json.hpp"

namespace vam::metrology {

Trend trend_of(std::span<const double> values, std::span<const double> uncertainties) {
  Trend found;
  found.prints = count_of(values);
  const auto n = static_cast<double>(values.size());
  for (const double value : values) found.mean += value / n;
  double squares = 0;
  double cross = 0;
  double places = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double at = static_cast<double>(i) - 0.5 * (n - 1);
    squares += std::pow(values[i] - found.mean, 2);
    cross += at * (values[i] - found.mean);
    places += at * at;
    found.uncertainty += std::pow(uncertainties[i], 2) / n;
  }
  found.spread = std::sqrt(squares / (n - 1));
  found.drift = cross / places;
  const double rest = std::max(0.0, squares - found.drift * cross);
  found.drift_sigma = std::sqrt(rest / (n - 2) / places);
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

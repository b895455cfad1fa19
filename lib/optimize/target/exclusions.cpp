// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/target/exclusions.hpp"

#include <algorithm>

#include "light/operators/insert.hpp"

namespace vam::optimize {

void exclude(Problem& problem, std::span<const Slab> inserts) {
  for_values(problem.target, [&](std::size_t s, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      if (!light::opaque(inserts[s].values[i])) continue;
      problem.labels[s][i] = Label::outside;
      problem.target[s].values[i] = 0.0F;
    }
  });
}

std::vector<std::int64_t> exclude_dark(Problem& problem, const light::Operator& light) {
  const std::vector<Slab> dose = light::dose_of_even_light(light, problem.target.size());
  float most = 0;
  for (const auto& lane : largest(dose)) most = std::max(most, *std::max_element(lane.begin(), lane.end()));
  std::vector<std::int64_t> dark(dose.size() * lanes, 0);
  for (std::size_t s = 0; s < dose.size(); ++s) {
    for (std::size_t i = 0; i < dose[s].values.size(); ++i) {
      Label& label = problem.labels[s][i];
      if (label == Label::outside || !light::in_shadow(dose[s].values[i], most)) continue;
      if (label == Label::part) ++dark[s * lanes + i % lanes];
      label = Label::outside;
    }
  }
  return dark;
}

}  // namespace vam::optimize

// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/threshold.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "optimize/methods/metrics.hpp"

namespace vam::optimize {

model::DoseStatistics statistics_of_all(const Scenarios& scenarios, const Problem& problem, const Iterate& state) {
  model::DoseStatistics all;
  const auto add = [&](std::span<const Slab> doses) {
    for (const auto& slice : statistics(doses, problem)) all.merge(slice);
  };
  add(state.dose);
  std::vector<Slab> dose = slabs(state.dose.size(), state.dose[0].width, state.dose[0].height);
  for (int one = 0; one < scenarios.count(); ++one) {
    scenarios.adjoint(one, state.g, dose);
    add(dose);
  }
  return all;
}

namespace {

/// The least part and the largest void dose of all lights, wherever the window of one of them lies.
PerSlice to_threshold_of_all(const Scenarios& scenarios, const Problem& problem, const Iterate& state) {
  const model::DoseMetrics m = statistics_of_all(scenarios, problem, state).metrics(false);
  const double middle = 0.5 * (m.min_part + m.max_void);
  const double factor = m.part > 0 && middle > 0 ? problem.demands.window.threshold() / middle : 1;
  return filled(state.g.size(), static_cast<float>(factor));
}

/// Scaled no more than puts the threshold in the middle half of the window: the dose on the surface is the threshold.
/// 0 where void takes more than part.
float true_to_surface(const model::DoseMetrics& m, double threshold) {
  const double width = m.min_part - m.max_void;
  if (m.part == 0 || !(width > 0)) return 0;
  const double highest = threshold / (m.max_void + 0.25 * width);
  const double lowest = threshold / (m.max_void + 0.75 * width);
  return static_cast<float>(std::clamp(1.0, lowest, highest));
}

PerSlice true_to_surface(const Problem& problem, ExposureGroup group, const Iterate& state, PerSlice otherwise) {
  const double threshold = problem.demands.window.threshold();
  const auto slices = group == ExposureGroup::slice ? metrics(state.dose, problem) : std::vector<model::DoseMetrics>{};
  const float shared = slices.empty() ? true_to_surface(body_metrics(state.dose, problem), threshold) : 0;
  for (int k = 0; k < problem.slices; ++k) {
    const float factor = slices.empty() ? shared : true_to_surface(slices[k], threshold);
    if (factor > 0) otherwise[k / lanes][k % lanes] = factor;
  }
  return otherwise;
}

void keep_below(double max_intensity, const light::Operator& light, ExposureGroup group, const Iterate& state,
                PerSlice& factor) {
  PerSlice brightest = largest(state.g);
  if (group == ExposureGroup::pass) brightest = largest_of_all(brightest);
  const auto most = static_cast<float>(max_intensity * light.row_angle_rad());
  for_slices(factor, [&](std::size_t s, std::size_t lane) {
    if (brightest[s][lane] > 0) factor[s][lane] = std::min(factor[s][lane], most / brightest[s][lane]);
  });
}

}  // namespace

void bring_to_threshold(const Problem& problem, const light::Operator& light, ExposureGroup group, double max_intensity,
                        const Scenarios* scenarios, Iterate& state) {
  PerSlice factor = scenarios != nullptr           ? to_threshold_of_all(*scenarios, problem, state)
                    : group == ExposureGroup::pass ? to_shared_threshold(state.dose, problem)
                                                   : to_common_threshold(metrics(state.dose, problem), problem);
  if (scenarios == nullptr && asks_surface(problem.demands)) {
    factor = true_to_surface(problem, group, state, std::move(factor));
  }
  if (max_intensity > 0) keep_below(max_intensity, light, group, state, factor);
  scale(state.g, factor);
  scale(state.dose, factor);
}

}  // namespace vam::optimize

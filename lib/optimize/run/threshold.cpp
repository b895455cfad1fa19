#include "optimize/run/private/threshold.hpp"

#include <algorithm>

#include "optimize/methods/metrics.hpp"

namespace vam::optimize {

namespace {

/// The least part and the largest void dose of all lights, wherever the window of one of them lies.
PerSlice to_threshold_of_all(const Scenarios& scenarios, const Problem& problem, const Iterate& state) {
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
  const model::DoseMetrics m = all.metrics(false);
  const double middle = 0.5 * (m.min_part + m.max_void);
  const double factor = m.part > 0 && middle > 0 ? problem.demands.window.threshold() / middle : 1;
  return filled(state.g.size(), static_cast<float>(factor));
}

void keep_below(double max_intensity, const light::Operator& light, Together together, const Iterate& state,
                PerSlice& factor) {
  PerSlice brightest = largest(state.g);
  if (together == Together::pass) brightest = largest_of_all(brightest);
  const auto most = static_cast<float>(max_intensity * light.row_angle_rad());
  for (std::size_t s = 0; s < factor.size(); ++s) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (brightest[s][lane] > 0) factor[s][lane] = std::min(factor[s][lane], most / brightest[s][lane]);
    }
  }
}

}  // namespace

void bring_to_threshold(const Problem& problem, const light::Operator& light, Together together, double max_intensity,
                        const Scenarios* scenarios, Iterate& state) {
  PerSlice factor = scenarios != nullptr         ? to_threshold_of_all(*scenarios, problem, state)
                    : together == Together::pass ? to_shared_threshold(state.dose, problem)
                                                 : to_common_threshold(metrics(state.dose, problem), problem);
  if (max_intensity > 0) keep_below(max_intensity, light, together, state, factor);
  scale(state.g, factor);
  scale(state.dose, factor);
}

}  // namespace vam::optimize

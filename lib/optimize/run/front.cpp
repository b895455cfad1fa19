// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/front.hpp"

#include <utility>

#include "optimize/methods/metrics.hpp"
#include "optimize/run/private/pass.hpp"
#include "optimize/run/private/threshold.hpp"

namespace vam::optimize {

void exchange(Archive& archive, std::vector<FrontPoint>& front) {
  archive.list(front, [&](FrontPoint& p) {
    model::DoseMetrics& m = p.metrics;
    for (double* field : {&p.max_intensity, &p.peak, &p.efficiency, &m.latitude, &m.ver, &m.pw, &m.iou, &m.min_part,
                          &m.max_void, &m.iou_threshold})
      archive(*field);
    auto faced = static_cast<int>(p.latitude_tolerances.has_value());
    archive(faced);
    if (faced == 0) return;
    if (!p.latitude_tolerances) p.latitude_tolerances = 0;
    archive(*p.latitude_tolerances);
  });
}

FrontPoint front_point(const Problem& problem, const light::Operator& light, double max_intensity, Iterate state,
                       const Scenarios* scenarios, const Show& show) {
  bring_to_threshold(problem, light, ExposureGroup::pass, max_intensity, scenarios, state);
  const Pass all{0, problem.slices, 0, problem.slices};
  const std::vector<Image> shown = show(expand_images(all, state.g, light));
  state.g = collapse_images(
      all, [&](int k) { return shown[k]; }, light);
  light.adjoint(state.g, state.dose);
  model::LightEfficiency seen;
  for (const Image& image : shown) seen.add(image.values);
  FrontPoint point{max_intensity, seen.max, seen.value(), body_metrics(state.dose, problem), std::nullopt};
  if (scenarios != nullptr)
    point.latitude_tolerances = statistics_of_all(*scenarios, problem, state).metrics().latitude;
  return point;
}

}  // namespace vam::optimize

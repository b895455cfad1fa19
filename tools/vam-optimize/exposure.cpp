// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/exposure.hpp"

#include "optics/projector_frames.hpp"
#include "resin/absolute_dose.hpp"
#include "score/exposure.hpp"

namespace vam::optimize_tool {

std::optional<double> fixed_threshold(const Options& options) {
  if (options.delivered.empty()) return std::nullopt;
  return options.demands.window.threshold();
}

double aimed_dose(const model::DoseMetrics& doses, const Options& options) {
  return fixed_threshold(options).value_or(score::aimed_dose(doses, options.demands.window.threshold()));
}

std::optional<score::ExposurePlan> exposure_of(const model::DoseMetrics& doses, double peak,
                                               const model::Printer& printer, const model::StackInfo& info,
                                               const Options& options) {
  const auto per_radian = resin::dose_per_radian_mj_cm3(printer);
  const double full_scale = options.full_scale.value_or(peak);
  if (!per_radian || !model::repeat(info.poses)) return std::nullopt;
  const double threshold = options.demands.window.threshold();
  model::DoseMetrics exact;
  exact.iou_threshold = threshold;
  const model::DoseMetrics& aim = fixed_threshold(options) ? exact : doses;
  const double middle = *per_radian / full_scale * score::window_middle(aim);
  if (!(full_scale > 0) || !(*printer.resin.critical_dose_mj_cm3 <= score::most_turns * middle)) return std::nullopt;
  return score::plan_exposure(aim, *per_radian / full_scale, printer, optics::turns_of(info), threshold);
}

bool states_exposure(const model::StackInfo& info, const model::Printer& printer, const Options& options) {
  return options.slices.empty() && !(options.turns && !options.delivered.empty()) && model::repeat(info.poses) &&
         resin::dose_per_radian_mj_cm3(printer).has_value();
}

}  // namespace vam::optimize_tool

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/exposure.hpp"

#include <cmath>

#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "model/dose/dose_spread.hpp"
#include "optics/projector_frames.hpp"
#include "optimize/run/shown.hpp"
#include "resin/absolute_dose.hpp"

namespace vam::optimize_tool {

namespace {

/// What completes a dose within given turns has a scale, and so an exposure.
bool gives_exposure(const Options& options) { return options.turns && !options.delivered.empty(); }

}  // namespace

double full_grey(const model::Printer& printer, double showings, const Options& options) {
  const double per_radian = resin::dose_per_radian_mj_cm3(printer).value();
  return showings * options.demands.window.threshold() * per_radian / *printer.resin.critical_dose_mj_cm3;
}

std::optional<double> fixed_threshold(const Options& options) {
  return options.delivered.empty() ? std::nullopt : std::optional(options.demands.window.threshold());
}

std::optional<score::ExposurePlan> plan_of(const model::DoseMetrics& doses, double peak, const model::Printer& printer,
                                           const model::StackInfo& info, const Options& options) {
  const double full_scale = options.full_scale.value_or(peak);
  if (gives_exposure(options)) {
    const double multiplier = full_scale / full_grey(printer, *options.turns / optics::turns_of(info), options);
    return score::ExposurePlan{*options.turns, multiplier, model::seconds_of(printer.stage, *options.turns),
                               multiplier * printer.projector.max_intensity_mw_cm2};
  }
  const auto per_radian = resin::dose_per_radian_mj_cm3(printer);
  if (!per_radian || !model::repeat(info.poses)) return std::nullopt;
  const double threshold = options.demands.window.threshold();
  model::DoseMetrics exact;
  exact.iou_threshold = threshold;
  const model::DoseMetrics& aim = fixed_threshold(options) ? exact : doses;
  const double middle = *per_radian / full_scale * verdict::window_middle(aim);
  if (!(full_scale > 0) || !(*printer.resin.critical_dose_mj_cm3 <= score::most_turns * middle)) return std::nullopt;
  return score::plan_exposure(aim, *per_radian / full_scale, printer, optics::turns_of(info), threshold);
}

bool states_exposure(const model::StackInfo& info, const model::Printer& printer, const Options& options) {
  return gives_exposure(options) ||
         (options.slices.empty() && model::repeat(info.poses) && resin::dose_per_radian_mj_cm3(printer).has_value());
}

Printing judge_printed(optimize::VolumeTask& task, const light::Operator& light, Sink& sink,
                       const session::Scene& scene, const model::StackInfo& info, const Options& options,
                       optimize::VolumeOutcome& outcome) {
  const model::Resin& resin = scene.printer.resin;
  const double compensated = session::diffusion_s(scene, options);
  const bool planned = states_exposure(info, scene.printer, options);
  const double aim = options.demands.window.threshold();
  Printing print;
  bool is_rounded = false;  // for the first plan
  const optimize::Expose expose = [&](const optimize::VolumeOutcome& seen) -> optimize::Exposed {
    if (!is_rounded) {
      print.plan = plan_of(seen.metrics, seen.peak_intensity, scene.printer, info, options);
      print.full_scale =
          options.full_scale.value_or(seen.peak_intensity) / (planned && print.plan ? print.plan->multiplier : 1);
    }
    const double showings = planned && print.plan ? print.plan->turns / optics::turns_of(info) : 0;
    print.of_exposure = fixed_threshold(options);
    if (!print.of_exposure && showings > 0)
      print.of_exposure = aim * print.full_scale / full_grey(scene.printer, showings, options);
    print.threshold = options.demands.grey ? verdict::PrintThreshold{aim}
                                           : verdict::print_threshold(seen.metrics, print.of_exposure, aim);
    return {print.threshold.dose, showings > 0 ? print.plan->seconds : compensated};
  };
  print.seconds = expose(outcome).seconds;
  sink.finish(print.full_scale, outcome.peak_intensity);
  is_rounded = options.bits && planned && print.plan;
  if (options.bits) outcome.surface.reset();
  const auto blur_px = [&](double seconds) { return session::blur_px(resin, seconds, scene, options); };
  if (options.slices.empty())
    print.seconds = optimize::judge_shown(task, light, sink.kept(), expose, blur_px, outcome).seconds;
  if (!options.blur || resin.diffusion_mm2_s == 0) return print;
  model::warn_of_diffusion(resin, print.seconds);
  if (std::abs(print.seconds - compensated) > 0.01 * print.seconds) {
    warn("the light compensates for the diffusion of " + format_number(compensated, 4) + " s, and its print takes " +
         format_number(print.seconds, 4) + " s; optimize.diffusion_time_s=" + format_number(print.seconds, 4) +
         " compensates for that");
  }
  return print;
}

}  // namespace vam::optimize_tool

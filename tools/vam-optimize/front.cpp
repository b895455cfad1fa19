#include "vam-optimize/front.hpp"

#include <sstream>
#include <utility>

#include "base/text.hpp"
#include "optics/frames.hpp"
#include "score/exposure.hpp"
#include "score/exposure_plan.hpp"
#include "vam-optimize/sink.hpp"

namespace vam::optimize_tool {

optimize::Show make_show(const model::Printer& printer, const Options& options) {
  const resin::GreyLevels levels = grey_levels(printer, options.bits.value_or(printer.projector.bits));
  return [levels, full_scale = options.full_scale,
          feedback = options.error_feedback](const std::vector<Image>& frames) {
    std::vector<Image> shown;
    optimize::Quantiser quantiser(levels, full_scale, feedback, [&](const Image& image) { shown.push_back(image); });
    for (const Image& frame : frames) quantiser.add(frame);
    quantiser.finish();
    return shown;
  };
}

std::string front_csv(const std::vector<optimize::FrontPoint>& front, const model::Printer& printer,
                      const model::StackInfo& info, const Options& options) {
  const auto per_radian = score::dose_per_radian_mj_cm3(printer);
  std::ostringstream csv;
  csv << "max_intensity,duration_s,turns,pw,ver,iou,peak\n";
  for (const optimize::FrontPoint& point : front) {
    csv << format_number(point.max_intensity) << ",";
    const double full_scale = options.full_scale.value_or(point.peak);
    if (per_radian && model::repeat(info.poses) && full_scale > 0 && score::window_middle(point.metrics) > 0) {
      const auto plan = score::plan_exposure(point.metrics, *per_radian / full_scale, printer, optics::turns_of(info),
                                             options.demands.window.threshold());
      csv << format_number(plan.seconds) << "," << plan.turns;
    } else {
      csv << ",";
    }
    for (const double figure : {point.metrics.pw, point.metrics.ver, point.metrics.iou, point.peak})
      csv << "," << format_number(figure);
    csv << "\n";
  }
  return csv.str();
}

}  // namespace vam::optimize_tool

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/sink.hpp"

#include <string>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "optimize/run/quantise.hpp"
#include "session/printer.hpp"

namespace vam::optimize_tool {

resin::GreyLevels grey_levels(const model::Printer& printer, int bits) {
  return {session::response_of(printer.projector), bits};
}

Sink::Sink(const Options& options, const model::Printer& printer, const model::StackInfo& info)
    : keep_(options.printer_tolerances || options.tolerances || options.bits || printer.resin.diffusion_mm2_s > 0),
      dither_(options.dither),
      out_(options.output, info, options.stack) {
  if (options.bits) levels_.emplace(grey_levels(printer, *options.bits));
}

void Sink::add(const Image& image) {
  if (!levels_) out_.write(image);
  if (keep_) kept_.push_back(image);
}

void Sink::finish(double full_scale, double peak) {
  if (!levels_) return;
  optimize::quantise(kept_, *levels_, full_scale, dither_);
  if (!(optimize::largest(kept_) > 0)) {
    throw Error{Fault::data, "--bits " + std::to_string(levels_->bits()) + ": the peak intensity of " +
                                 format_number(peak, 3) + " rounds to 0 at a full scale of " +
                                 format_number(full_scale, 3) +
                                 "; the frames would be dark; use a smaller optimize.full_scale, more bits, or less "
                                 "light (a faster stage, a lower projector.max_intensity_mw_cm2)"};
  }
  if (peak > full_scale) {
    warn("the peak intensity of " + format_number(peak, 3) + " exceeds optimize.full_scale " +
         format_number(full_scale, 3) + " and is clipped");
  }
  for (const Image& image : kept_) out_.write(image);
}

}  // namespace vam::optimize_tool

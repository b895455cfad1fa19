// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/sink.hpp"

#include <algorithm>
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
    : dither_(options.dither), shape_{info.width, info.height}, out_(options.output, info, options.stack) {
  if (options.bits) levels_.emplace(grey_levels(printer, *options.bits));
}

void Sink::add(const Image& image) {
  kept_.add(image);
  if (!levels_) out_.write(image);
}

void Sink::finish(double full_scale, double peak) {
  if (!levels_) return;
  double most = 0;
  for (int k = 0; k < kept_.count(); ++k) {
    Image image = kept_.at(k, shape_);
    optimize::quantise({&image, 1}, *levels_, full_scale, dither_);
    most = std::max(most, optimize::largest({&image, 1}));
    kept_.replace(k, image);
  }
  if (!(most > 0)) {
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
  for (int k = 0; k < kept_.count(); ++k) out_.write(kept_.at(k, shape_));
}

}  // namespace vam::optimize_tool

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-optimize/sink.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/text.hpp"
#include "session/printer.hpp"

namespace vam::optimize_tool {

resin::GreyLevels grey_levels(const model::Printer& printer, int bits) {
  return {session::response_of(printer.projector), bits};
}

Sink::Sink(const Options& options, const model::Printer& printer, const model::StackInfo& info)
    : keep_(options.printer_tolerances || options.bits || printer.resin.diffusion_mm2_s > 0),
      bits_(options.bits),
      full_scale_(options.full_scale),
      out_(options.output, info, options.stack) {
  if (!options.bits) return;
  levels_.emplace(grey_levels(printer, *options.bits), options.full_scale, options.dither,
                  [this](const Image& image) { write(image); });
}

void Sink::write(const Image& image) {
  out_.write(image);
  most_ = std::max(most_, *std::max_element(image.values.begin(), image.values.end()));
  if (keep_) kept_.push_back(image);
}

void Sink::add(const Image& image) {
  if (levels_) {
    levels_->add(image);
  } else {
    write(image);
  }
}

void Sink::finish() {
  if (levels_) levels_->finish();
}

void Sink::require_light(double peak) const {
  if (!bits_) return;
  const double full = full_scale_.value_or(peak);
  if (!(most_ > 0)) {
    throw Error{Fault::data, "--bits " + std::to_string(*bits_) + ": the peak intensity of " + format_number(peak, 3) +
                                 " rounds to 0 at a full scale of " + format_number(full, 3) +
                                 "; the frames would be dark; use a smaller optimize.full_scale or more bits"};
  }
  if (peak <= full) return;
  warn("the peak intensity of " + format_number(peak, 3) + " exceeds optimize.full_scale " + format_number(full, 3) +
       " and is clipped");
}

}  // namespace vam::optimize_tool

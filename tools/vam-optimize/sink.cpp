#include "vam-optimize/sink.hpp"

#include <algorithm>

#include "response.hpp"

namespace vam::optimize_tool {

resin::GreyLevels grey_levels(const model::Printer& printer, int bits) {
  return {tool::response_of(printer.projector), bits};
}

Sink::Sink(const Options& options, const model::Printer& printer, const model::StackInfo& info)
    : keep_(options.printer_tolerances.has_value()),
      out_(options.output, info, options.stack),
      progress_("optimising", info.count) {
  if (!options.bits) return;
  levels_.emplace(grey_levels(printer, *options.bits), options.full_scale, options.dither_turns.has_value(),
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
  progress_.tick();
}

void Sink::finish() {
  if (levels_) levels_->finish();
}

}  // namespace vam::optimize_tool

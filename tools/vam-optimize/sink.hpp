// SPDX-License-Identifier: GPL-3.0-or-later
// Writes finished slices.
#pragma once

#include <optional>

#include "base/image.hpp"
#include "io/exr/stack.hpp"
#include "model/printer.hpp"
#include "optimize/run/shown.hpp"
#include "resin/response.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// The projector's grey levels, through its response. Throws Error when the response cannot be read.
[[nodiscard]] resin::GreyLevels grey_levels(const model::Printer& printer, int bits);

/// Into the stack, quantised to the grey levels of the projector on request. What was written is kept, to be judged.
class Sink {
 public:
  Sink(const Options& options, const model::Printer& printer, const model::StackInfo& info);
  void add(const Image& image);
  /// After the last slice, of light with that peak: the grey levels of --bits, full grey at full_scale. Throws
  /// Fault::data where all of it rounds to level 0, warns where full grey is below the peak.
  void finish(double full_scale, double peak);
  void state(const model::Metadata& facts) { out_.state(facts); }
  void commit() { out_.commit(); }
  [[nodiscard]] const optimize::Frames& kept() const { return kept_; }

 private:
  bool dither_;
  light::Shape shape_;
  optimize::Frames kept_;
  io::StackWriter out_;
  std::optional<resin::GreyLevels> levels_;
};

}  // namespace vam::optimize_tool

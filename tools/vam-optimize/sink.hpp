// Writes finished slices.
#pragma once

#include <optional>
#include <vector>

#include "base/image.hpp"
#include "base/log.hpp"
#include "io/exr/stack.hpp"
#include "model/printer.hpp"
#include "optimize/run/quantise.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Of the projector, through its response. Throws Error when the response cannot be read.
[[nodiscard]] resin::GreyLevels grey_levels(const model::Printer& printer, int bits);

/// Into the stack, quantised to the projector's grey levels on request. With --robust all is kept to be judged.
class Sink {
 public:
  Sink(const Options& options, const model::Printer& printer, const model::StackInfo& info);
  void add(const Image& image);
  /// After the last slice.
  void finish();
  void commit() { out_.commit(); }
  /// Of all that was written.
  [[nodiscard]] double largest() const { return static_cast<double>(most_); }
  /// All that was written, in order, if it was to be kept.
  [[nodiscard]] const std::vector<Image>& kept() const { return kept_; }

 private:
  void write(const Image& image);
  bool keep_;
  float most_ = 0;
  std::vector<Image> kept_;
  io::StackWriter out_;
  std::optional<optimize::Quantiser> levels_;
  Progress progress_;
};

}  // namespace vam::optimize_tool

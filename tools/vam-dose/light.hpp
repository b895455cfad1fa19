// SPDX-License-Identifier: GPL-3.0-or-later
// The light that a vial gets, slice by slice: that of a sinogram, or of all that a print showed.
#pragma once

#include <memory>
#include <vector>

#include "base/image.hpp"
#include "io/exr/stack.hpp"
#include "light/simulation/display_range.hpp"
#include "model/printer.hpp"
#include "model/stack.hpp"
#include "vam-dose/options.hpp"

namespace vam::dose_tool {

class Light {
 public:
  /// Opens the sinograms; the first is `first`, of which `info` states the poses to judge it by. Throws Fault::usage
  /// for several without --shown, Fault::data where they differ in size, or nothing of any was shown.
  Light(io::StackReader& first, const model::StackInfo& info, const Options& options, const model::Printer& printer,
        double stated_turns);
  ~Light();
  Light(const Light&) = delete;
  Light& operator=(const Light&) = delete;

  /// From now on next() gives so many slices at a time.
  void begin(int batch);
  /// Intensities of the next slices, times the turns for which each row was shown; empty after the last.
  [[nodiscard]] std::vector<Image> next();
  [[nodiscard]] const light::LightSeen& seen() const { return seen_; }
  /// Whether these tools wrote the first sinogram.
  [[nodiscard]] bool sealed() const { return sealed_; }
  /// Mean over the stage angles, of all sinograms; 0 without --shown.
  [[nodiscard]] double turns() const { return turns_; }

 private:
  struct Part;
  std::vector<std::unique_ptr<Part>> parts_;
  light::LightSeen seen_;
  bool sealed_;
  double turns_ = 0;
};

}  // namespace vam::dose_tool

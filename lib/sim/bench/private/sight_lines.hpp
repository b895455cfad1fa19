// SPDX-License-Identifier: GPL-3.0-or-later
// What the pixels of a simulated camera see of a simulated print: the sum of what scatters along rays that climb.
#pragma once

#include <vector>

#include "base/image.hpp"
#include "model/printer.hpp"
#include "sim/bench/photoresin.hpp"
#include "sim/bench/private/ray.hpp"

namespace vam::sim {

/// The rays of all pixels of a camera whose middle looks at the axis.
class SightLines {
 public:
  SightLines(const model::Printer& printer, int columns, int rows, double pixel_mm);
  /// Path through what scatters times its density and the transmittance, mm, on a part at that angle.
  [[nodiscard]] Image view(const Photoresin& resin, double part_rad) const;

 private:
  double azimuth_rad_;
  int columns_;
  int rows_;
  std::vector<ClimbingRay> rays_;  // rows downwards
};

}  // namespace vam::sim

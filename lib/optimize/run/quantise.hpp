// SPDX-License-Identifier: GPL-3.0-or-later
// Projections in the grey levels that the projector has.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/image.hpp"
#include "resin/dither.hpp"

namespace vam::optimize {

/// Rounds fluence to the intensities of a projector's grey levels. Full grey is `full_scale`, or the largest value of
/// all images when there is none: then images are held until finish(). With error feedback what rounding leaves over
/// goes to the neighbouring columns and angles (resin::Dither), so that sums over angles, which are the dose, stay
/// right.
class Quantiser {
 public:
  using Emit = std::function<void(const Image&)>;

  Quantiser(resin::GreyLevels levels, std::optional<double> full_scale, bool error_feedback, Emit emit);
  void add(const Image& image);
  void finish();

 private:
  [[nodiscard]] Image quantised(const Image& image, float full_scale) const;
  resin::GreyLevels levels_;
  std::optional<double> full_scale_;
  std::optional<resin::Dither> dither_;
  Emit emit_;
  std::vector<Image> held_;
};

}  // namespace vam::optimize

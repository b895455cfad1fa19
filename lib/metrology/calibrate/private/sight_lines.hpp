// SPDX-License-Identifier: GPL-3.0-or-later
// The image of a thin luminous sheet in the resin, seen by a camera beside the vial.
#pragma once

#include <vector>

#include "model/printer.hpp"
#include "optics/chief_ray.hpp"

namespace vam::metrology {

/// All chief rays of the camera through the resin. Near grazing they cross each other, and so many of them that pass
/// one place make it bright: the image of a sheet has a kink where the sheet leaves such a place.
class SightLines {
 public:
  /// Throws Fault::data where lens, window and vial cannot stand like that.
  explicit SightLines(const model::Printer& printer);
  /// Sum over the image's columns of what shines on their line of sight from the sheet that the projector's `ray`
  /// stands for; a ray that goes along the sheet of a whole diameter would give 1. The resin's absorption weakens the
  /// sheet on its way, and at the camera's wavelength what the camera sees of it. 0 for a ray that passes beside the
  /// resin.
  [[nodiscard]] double seen(const optics::ChiefRay& ray) const;

 private:
  struct Sight {
    double offset_mm = 0, cosine = 1, sine = 0;  // of the line of sight, as optics::ChiefRay has them
    double chord_mm = 0;                         // half of it
    double weight = 0;                           // transmittance x part of the image, up to the next one
  };
  double radius_mm_;  // of the resin
  double absorption_per_mm_, seen_absorption_per_mm_;
  std::vector<Sight> sights_;
};

}  // namespace vam::metrology

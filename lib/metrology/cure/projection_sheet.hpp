// SPDX-License-Identifier: GPL-3.0-or-later
// Overview for the operator: the print and its design, each seen from above and from two sides [OST22 fig 5].
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metrology/cure/cured.hpp"

namespace vam::metrology {

/// Views of one size, padded with zeros, in rows of three: top (along z), front (along y), side (along x).
struct Sheet {
  std::vector<Image> images;
  std::vector<std::string> captions;
  double pixel_mm = 0;
  float brightest = 0;
};

/// One row for the scattering volume; with a level one for { scatter >= level }; with a target one for its design,
/// sampled at the volume's voxels. Each row is scaled to its own brightest pixel.
[[nodiscard]] Sheet projection_sheet(const model::Volume& scatter, std::optional<double> level,
                                     const model::StretchedVolume* target);

}  // namespace vam::metrology

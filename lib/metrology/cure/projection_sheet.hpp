// SPDX-License-Identifier: GPL-3.0-or-later
// Overview for the operator: the print and its design, each seen from above and from two sides [OST22 fig 5].
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "metrology/cure/cured.hpp"

namespace vam::metrology {

struct SheetView {
  Image image;  // pixels of a voxel, the brightest of its row 1
  std::string caption;
};

/// Views of one size, padded with zeros, in rows of three: top (along z), front (along y), side (along x). One row for
/// the scattering volume; with a level one for { scatter >= level }; with a target one for its design, sampled at the
/// volume's voxels.
[[nodiscard]] std::vector<SheetView> projection_sheet(const model::Volume& scatter, std::optional<double> level,
                                                      const model::StretchedVolume* target);

}  // namespace vam::metrology

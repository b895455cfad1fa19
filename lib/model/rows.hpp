// SPDX-License-Identifier: GPL-3.0-or-later
// Heights of a projector's rows.
#pragma once

#include "model/printer.hpp"

namespace vam::model {

/// Of the middle of a row in the plane of the rotation axis: rows are numbered downwards from 0, z is up and 0 level
/// with the lens.
[[nodiscard]] inline double z_mm(const Projector& projector, double row) {
  return (projector.axis_row - row) * projector.pixel_mm;
}

}  // namespace vam::model

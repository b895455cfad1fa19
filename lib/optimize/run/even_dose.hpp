// SPDX-License-Identifier: GPL-3.0-or-later
// The dose if every pixel is fully lit at every stage angle.
#pragma once

#include "light/operators/operator.hpp"
#include "model/circle.hpp"

namespace vam::optimize {

/// Dose inside the circle where every pixel has intensity 1 at every angle. It does not depend on the size of the
/// voxels.
struct EvenDose {
  double mean = 0;
  double largest = 0;
};

[[nodiscard]] EvenDose even_dose(const light::Operator& light, const model::Circle& circle, int slices);

}  // namespace vam::optimize

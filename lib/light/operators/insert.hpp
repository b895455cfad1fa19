// SPDX-License-Identifier: GPL-3.0-or-later
// Opaque inserts (overprinting): which voxels are insert, and which are in its shadow.
#pragma once

#include <cstddef>

#include "model/dose/dose_metrics.hpp"

namespace vam::light {

/// A voxel is opaque if an insert covers at least half of it.
[[nodiscard]] constexpr bool opaque(float coverage) { return model::half_covered(coverage); }

/// A voxel is in shadow if even light gives it at most 1 % of the largest dose, with which nothing prints.
[[nodiscard]] constexpr bool in_shadow(float even_dose, float largest) { return !(even_dose > 0.01F * largest); }

/// No dose in the voxels that are at least half insert.
template <class Voxels>
void darken(const Voxels& insert, Voxels& dose) {
  for (std::size_t i = 0; i < dose.values.size(); ++i) {
    if (opaque(insert.values[i])) dose.values[i] = 0;
  }
}

}  // namespace vam::light

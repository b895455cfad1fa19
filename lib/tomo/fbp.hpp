// SPDX-License-Identifier: GPL-3.0-or-later
// Filtered back-projection, plain and exponential, and the geometry that fits a grid.
#pragma once

#include <span>

#include "model/circle.hpp"
#include "model/grid.hpp"
#include "tomo/filter.hpp"
#include "tomo/radon.hpp"

namespace vam::tomo {

/// `angles` over 360 degrees, endpoint excluded, for the slices of a grid whose rotation axis is at x = y = 0 mm.
/// columns = 0 takes the fewest that see every corner of the grid, as odd or even as nx, so that for a centred grid the
/// bins of angle 0 are the pixels. Throws Error{Fault::usage} unless angles >= 1 and columns >= 0.
[[nodiscard]] ParallelGeometry full_turn(const model::Grid& grid, int angles, int columns = 0,
                                         double attenuation_per_mm = 0);

/// The fewest columns that see the circle, odd or even as nx, so that the columns of angle 0 are voxels.
[[nodiscard]] int columns_across(const model::Circle& circle, int nx);

/// Inverts forward(): images = (pi / angles) * adjoint(filter(sinograms)), for angles over a half or a full turn. With
/// alpha != 0 (a full turn is needed) it is the inverse of [TM80, CAL19 eq 2]: |k| < alpha blocked, weight e^{-alpha
/// u}. The sinograms are left filtered. spec.alpha_per_px is set from the geometry. Throws Error{Fault::usage}.
void fbp(const ParallelGeometry& geometry, std::span<Slab> sinograms, std::span<Slab> images, FilterSpec spec = {});

/// The same for one slab.
[[nodiscard]] Slab fbp(const ParallelGeometry& geometry, Slab sinogram, const FilterSpec& spec = {});

}  // namespace vam::tomo

// SPDX-License-Identifier: GPL-3.0-or-later
// How well the surface of a reconstructed print is known, from how well its scattering is [physics §8].
#pragma once

#include <span>
#include <vector>

#include "base/vector3.hpp"
#include "model/grid.hpp"

namespace vam::metrology {

/// How far an isosurface moves along its normal with the isovalue: 1 / |gradient| in mm per unit of the volume, of
/// the trilinear field. At most 3 voxels per 10 % of the volume's largest value, where
/// the volume is flat.
[[nodiscard]] std::vector<float> mm_per_value(const model::Volume& volume, std::span<const Vector3> points);

/// The noise of a volume: the standard deviation of each voxel, on its grid or another, and how far the noise of
/// neighbours along x or y, and along z, is the same.
struct VoxelUncertainty {
  model::Volume sigma;
  double correlation_xy = 0;
  double correlation_z = 0;
};

/// Standard uncertainty along the normal of points of an isosurface of `scatter`: that of the trilinear value over the
/// gradient.
[[nodiscard]] std::vector<float> surface_uncertainty_mm(const model::Volume& scatter, const VoxelUncertainty& voxels,
                                                        std::span<const Vector3> points);

}  // namespace vam::metrology

// How well the surface of a reconstructed print is known, from how well its scattering is [physics §8].
#pragma once

#include <span>
#include <vector>

#include "base/vector3.hpp"
#include "model/grid.hpp"

namespace vam::metrology {

/// How far an isosurface moves along its normal with the isovalue: 1 / |gradient| in mm per unit of the volume, by
/// central differences over half a voxel either side. At most 3 voxels per 10 % of the volume's largest value, where
/// the volume is flat.
[[nodiscard]] std::vector<float> mm_per_value(const model::Volume& volume, std::span<const Vector3> points);

/// Standard uncertainty along the normal of points of an isosurface of `scatter`; `sigma` is the standard deviation of
/// its values, on its grid or another.
[[nodiscard]] std::vector<float> surface_uncertainty_mm(const model::Volume& scatter, const model::Volume& sigma,
                                                        std::span<const Vector3> points);

}  // namespace vam::metrology

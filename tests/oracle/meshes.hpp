// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes whose volume and inside are known, and the damage that files come with.
#pragma once

#include <array>
#include <cstdint>

#include "model/mesh.hpp"

namespace vam::oracle {

/// A sphere about the origin: `bands` x `2 bands` quadrilaterals cut in two, triangles at the poles: 4 bands (bands -
/// 1) triangles, outward.
model::TriangleSoup sphere(double radius, int bands);

/// The same with every vertex wobbling by `amount` of the radius: not symmetric, like a scan.
model::TriangleSoup lumpy_sphere(double radius, int bands, double amount);

/// A box from low to high, twelve outward triangles.
model::TriangleSoup box(const std::array<double, 3>& low, const std::array<double, 3>& high);

/// Both, side by side in one soup, the second moved.
model::TriangleSoup join(const model::TriangleSoup& a, const model::TriangleSoup& b,
                         const std::array<double, 3>& shift = {0, 0, 0});

/// Every triangle with corners of its own, as in an STL file.
model::TriangleSoup unwelded(const model::TriangleSoup& mesh);
/// Unwelded, each corner moved at random by up to `amount` along each axis.
model::TriangleSoup cracked(const model::TriangleSoup& mesh, double amount, std::uint32_t seed);
/// Without / with turned-over / with repeated: a random share of the triangles.
model::TriangleSoup without(const model::TriangleSoup& mesh, double share, std::uint32_t seed);
model::TriangleSoup flipped(const model::TriangleSoup& mesh, double share, std::uint32_t seed);
model::TriangleSoup repeated(const model::TriangleSoup& mesh, double share, std::uint32_t seed);
/// Without the triangles whose centroid lies within `radius` of `centre`.
model::TriangleSoup punched(const model::TriangleSoup& mesh, const std::array<double, 3>& centre, double radius);

/// Sum of the signed tetrahedra with the origin.
double signed_volume(const model::TriangleSoup& mesh);

}  // namespace vam::oracle

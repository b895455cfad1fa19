// SPDX-License-Identifier: GPL-3.0-or-later
// A vector ray tracer for the vial: rays and surfaces in 3-D, Snell's law and Fresnel's equations in vector form, no
// angles and no invariants. Slow and obvious; shares nothing with lib/optics.
#pragma once

#include <array>
#include <optional>
#include <vector>

namespace vam::oracle {

using Real = long double;
using Vec = std::array<Real, 3>;

struct Ray {
  Vec point{};
  Vec direction{};         // unit vector
  Real transmittance = 1;  // unpolarised
};

struct Cylinder {
  Real radius = 0;
  Real index = 1;  // inside
};

/// The bench: light along +y, vial axis = z axis. window > 0: the half space y > -window has index bath.
struct Bench {
  std::optional<Real> lens_distance;
  Real bath = 1;
  Real window = 0;
  std::vector<Cylinder> cylinders;  // outermost first
  Real axis_x = 0, axis_y = 0;      // of the cylinders
};

/// The ray that would pass (x, 0, z) if nothing were in its way, followed into the innermost cylinder. Empty if it
/// misses a surface or is totally reflected.
std::optional<Ray> trace(const Bench& bench, Real x, Real z = 0);

/// The in-plane line { t (cos a, sin a) + u (-sin a, cos a) } on which the ray runs.
struct Line {
  Real t = 0;
  Real a = 0;
};
Line line_of(const Ray& ray);

}  // namespace vam::oracle

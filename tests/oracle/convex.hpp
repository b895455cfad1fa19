// SPDX-License-Identifier: GPL-3.0-or-later
// The volume that a cube shares with a convex body, exactly, by cutting the cube with one half space after another.
#pragma once

#include <array>
#include <vector>

namespace vam::oracle {

/// { p : normal . p <= offset }
struct HalfSpace {
  std::array<double, 3> normal;
  double offset;
};

/// Volume of the cube of that centre and edge within all half spaces.
double shared_volume(const std::array<double, 3>& centre, double edge, const std::vector<HalfSpace>& body);

}  // namespace vam::oracle

// SPDX-License-Identifier: GPL-3.0-or-later
// The solids behind the names of shapes.cpp; values in the order of the catalogue.
#pragma once

#include <span>
#include <string>

#include "solid/shapes/field.hpp"

namespace vam::solid::build {

using Values = std::span<const double>;

// basic.cpp
Field sphere(Values v);
Field cylinder(Values v);
Field half_cylinder(Values v);
Field hollow_cylinder(Values v);
Field box(Values v);
Field cone(Values v);
Field torus(Values v);
Field egg_shell(Values v);

// lattice.cpp
Field gyroid(Values v);
Field octet(Values v);
Field ball_in_cage(Values v);

// target.cpp
Field disc_grid(Values v);
Field ladder(Values v);
Field resolution(Values v);

// boat.cpp
Field boat(Values v);
Field screwdriver(Values v);
Field handle(Values v);

/// Throws Fault::usage with the line unless it holds.
void require(bool holds, const std::string& line);

/// A solid from its field, its box, its radius about the z axis and its largest curvature; the ball is that of the box.
Field solid(std::function<double(const Point&)> value, const Point& low, const Point& high, double radius_mm,
            double curvature_per_mm);

}  // namespace vam::solid::build

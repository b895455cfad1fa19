// SPDX-License-Identifier: GPL-3.0-or-later
// The dose at a point by counting rays: very many rays a column, each leaving its light along its chord through a small
// disc around the point. No map is inverted and no density is computed.
#pragma once

#include <functional>
#include <vector>

#include "oracle/ray_tracer.hpp"

namespace vam::oracle {

struct RayDose {
  Bench bench;
  double half_field = 0;  // rays from -half_field to +half_field in the plane of the axis
  int rays = 0;
  double absorption = 0;  // per length
  int angles = 0;         // over one turn, from 0
};

/// Mean dose of one turn over the disc of this radius around (x, y): sum over angles (times the angle step) of light
/// per width. intensity(x_p, theta).
double ray_dose(const RayDose& setup, const std::function<double(double, double)>& intensity, double x, double y,
                double radius);

}  // namespace vam::oracle

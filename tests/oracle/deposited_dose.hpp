// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of a whole print by deposition: every pixel a bundle of rays, each followed by vector Snell's law into the
// resin and through the voxels, in each of which it leaves its power times the length of its way there. No map is
// inverted, no density computed, no footprint assumed; quick enough for parts of some million voxels.
#pragma once

#include <vector>

#include "base/image.hpp"
#include "oracle/ray_tracer.hpp"

namespace vam::oracle {

struct Deposit {
  Bench bench;
  double pixel = 0;        // pitch of the columns in the plane of the axis
  double row = 0;          // pitch of the rows there
  double axis_column = 0;  // where the axis appears
  int rays = 4;            // across and along a pixel
  double absorption = 0;   // per length
  int angles = 0;          // one turn, a multiple of 4
  double first_angle = 0;  // radians; the part turns by minus that
  double angle_step = 0;
  int size = 0, slices = 0;      // voxels: size x size around the axis
  double voxel = 0, height = 0;  // edge, and height of a voxel
  double first_slice = 0;        // z of the lowest voxel centres, from the lens's axis
};

struct Deposited {
  std::vector<double> dose;  // mean fluence of the voxels, one turn, times radians: [slice][y][x]
  double entered = 0;        // power into the resin, summed over angles
  double absorbed = 0;       // of that
};

/// One row of light, z from the lens's axis in the plane of the rotation axis: columns x angles of intensity. Adds to
/// the result, whose dose has its size.
void deposit(const Deposit& setup, const Image& row, double z, Deposited& result);

}  // namespace vam::oracle

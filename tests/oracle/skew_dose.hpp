// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of light that climbs, by deposition: many rays a pixel, each followed by vector Snell's law into the resin
// and through the voxels in small steps, leaving its power times the length of its way. No map is inverted, no density
// computed, no footprint assumed.
#pragma once

#include <functional>
#include <vector>

#include "oracle/ray_tracer.hpp"

namespace vam::oracle {

/// Where things are at one angle: off the axis by (x, y, z), the vial with the part, or the part alone.
struct SkewPose {
  double x = 0, y = 0, z = 0;
  bool vial = false;
};

struct SkewDose {
  Bench bench;
  double pixel = 0;           // pitch in the plane of the axis, across and along z
  int columns = 0, rows = 0;  // the axis in the middle of the columns
  double first_row = 0;       // z of row 0 in the plane of the axis, from the lens's axis; rows go up
  int rays = 0;               // across and along a pixel
  double absorption = 0;      // per length
  int angles = 0;             // over `turns` turns, from 0
  double turns = 1;
  std::vector<SkewPose> poses;                          // one an angle, or none
  int size = 0, slices = 0;                             // voxels: size x size around the axis
  double voxel = 0, height = 0;                         // edge, and height of a voxel
  double first_slice = 0;                               // z of the lowest voxel centres, from the lens's axis
  std::function<bool(int i, int j, int slice)> opaque;  // voxels that end a ray; none: nothing does
};

struct SkewResult {
  std::vector<double> dose;  // mean fluence of the voxels, one turn (times the angle step): [slice][y][x]
  double entered = 0;        // power that entered the resin, summed over angles
  double absorbed = 0;       // power times (1 - what is left where it goes out of the resin)
};

/// intensity(column, row, angle index): power per area in the image plane.
SkewResult skew_dose(const SkewDose& setup, const std::function<double(int, int, int)>& intensity);

}  // namespace vam::oracle

// SPDX-License-Identifier: GPL-3.0-or-later
// The dose around an opaque insert by walking: every ray leaves its light step by step in the voxel it is in, until it
// steps into the insert. No footprint, no table, no map is inverted.
#pragma once

#include <vector>

namespace vam::oracle {

/// A ray of every angle: its line L(t, theta + a), and its light per length of path.
struct WalkedRay {
  double t = 0;
  double a = 0;
  double light = 0;
};

struct WalkedDose {
  int size = 0;  // voxels across a square around the axis
  double voxel = 0;
  double edge = 0;        // radius of the resin, where the rays begin
  double absorption = 0;  // per length
  std::vector<double> angles;
  std::vector<WalkedRay> rays;
  std::vector<float> insert;  // coverage, row-major; from a half on nothing passes
};

/// Mean dose of every voxel over one turn, row-major; steps of a tenth of a voxel.
std::vector<double> walked_dose(const WalkedDose& setup);

}  // namespace vam::oracle

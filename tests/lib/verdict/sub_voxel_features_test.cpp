// SPDX-License-Identifier: GPL-3.0-or-later
// Walls and gaps that voxels are too coarse for.
#include "verdict/sub_voxel_features.hpp"

#include "testing.hpp"

using namespace vam;

namespace {

/// Walls of that thickness and distance along x, in voxels, through a box of 24^3 with 3 voxels of void around.
model::Volume walls(double thick, double apart, double from) {
  model::Volume volume{model::centred_grid(30, 30, 30, 1), {}};
  volume.values.assign(volume.grid.size(), 0.0F);
  for (int k = 3; k < 27; ++k) {
    for (int j = 3; j < 27; ++j) {
      for (int i = 3; i < 27; ++i) {
        double covered = 0;
        for (double low = 3 + from; low < 27; low += thick + apart) {
          covered += std::max(0.0, std::min(low + thick, i + 1.0) - std::max<double>(low, i));
        }
        volume.slice(k)[j * 30 + i] = static_cast<float>(std::min(covered, 1.0));
      }
    }
  }
  return volume;
}

verdict::SubVoxelFeatures found(const model::Volume& volume) {
  verdict::SubVoxelFinder finder(volume.grid);
  finder.add(volume.grid.nz, volume.values.data());
  return finder.found();
}

}  // namespace

TEST_CASE("thick walls with wide gaps are resolved wherever they lie") {
  for (const double from : {0.0, 0.3, 0.5, 0.8}) CHECK(found(walls(3, 4, from)).share() == 0);
}

TEST_CASE("walls thinner than a voxel are not, and all of them count") {
  const verdict::SubVoxelFeatures thin = found(walls(0.5, 4, 0.2));
  CHECK(thin.part == doctest::Approx(thin.whole));
  CHECK(thin.gaps == 0);
}

TEST_CASE("nor are gaps thinner than a voxel") {
  const verdict::SubVoxelFeatures narrow = found(walls(5, 0.5, 0.2));
  CHECK(narrow.part == 0);
  // Three gaps of 0.5 voxels wholly within the walls; the part's outer faces beside them are open.
  CHECK(narrow.gaps > 0.5 * 3 * 22 * 22);
  CHECK(narrow.share() > 0.05);
}

TEST_CASE("the slice with most of it is found") {
  model::Volume volume = walls(3, 4, 0);
  for (int i = 5; i < 20; ++i) volume.slice(1)[1 * 30 + i] = 0.5F;  // a rod in the open
  volume.slice(2)[1 * 30 + 5] = 0.5F;                               // two voxels of fifteen
  volume.slice(2)[1 * 30 + 6] = 0.5F;
  volume.slice(28)[1 * 30 + 5] = 0.5F;  // less than a tenth
  const verdict::SubVoxelFeatures most = found(volume);
  CHECK(most.slice == 1);
  CHECK(most.first == 1);
  CHECK(most.end == 3);
  CHECK(most.part == 9);
}

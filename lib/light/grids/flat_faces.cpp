// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/flat_faces.hpp"

#include <algorithm>
#include <utility>

#include "base/index.hpp"
#include "model/dose/dose_metrics.hpp"

namespace vam::light {

namespace {

constexpr int straight = 3;  // chamfer distances, in thirds of a voxel
constexpr int diagonal = 4;
constexpr double least_px = 4;  // width of a face

/// Twice the largest distance of a voxel of the mask from what is not in it, in voxels; the grid's rim is not in it.
double width_px(const std::vector<char>& mask, int nx, int ny) {
  std::vector<int> distance(mask.size(), 0);
  const auto relax = [&](std::ptrdiff_t at, int x, int step) {  // from the row before and the voxel before
    const std::ptrdiff_t row = std::ptrdiff_t{step} * nx;
    int least = std::min(distance[at - step], distance[at - row]) + straight;
    least = std::min(least,
                     std::min(x > 0 ? distance[at - row - 1] : 0, x < nx - 1 ? distance[at - row + 1] : 0) + diagonal);
    return least;
  };
  constexpr int far = 1 << 28;
  for (int y = 1; y < ny - 1; ++y) {
    for (int x = 1; x < nx - 1; ++x) {
      const auto at = std::ptrdiff_t{y} * nx + x;
      distance[at] = mask[at] != 0 ? std::min(far, relax(at, x, 1)) : 0;
    }
  }
  int most = 0;
  for (int y = ny - 2; y > 0; --y) {
    for (int x = nx - 2; x > 0; --x) {
      const auto at = std::ptrdiff_t{y} * nx + x;
      if (mask[at] == 0) continue;
      distance[at] = std::min(distance[at], relax(at, x, -1));
      most = std::max(most, distance[at]);
    }
  }
  return most > 0 ? 2.0 * most / straight - 1 : 0;
}

}  // namespace

FlatFaceFinder::FlatFaceFinder(const model::Grid& grid) : grid_(grid), below_(grid.slice_size(), 0) {}

void FlatFaceFinder::add(int count, const float* slices) {
  Mask above(grid_.slice_size());
  for (int n = 0; n < count; ++n, slices += grid_.slice_size()) {
    std::transform(slices, slices + grid_.slice_size(), above.begin(),
                   [](float f) { return model::half_covered(f) ? 1 : 0; });
    compare(above);
    below_.swap(above);
  }
}

std::vector<FlatFace> FlatFaceFinder::faces() {
  compare(Mask(grid_.slice_size(), 0));
  return std::move(faces_);
}

void FlatFaceFinder::compare(const Mask& above) {
  Mask face(above.size());
  for (const bool up : {false, true}) {
    const Mask& part = up ? below_ : above;
    const Mask& other = up ? above : below_;
    std::transform(part.begin(), part.end(), other.begin(), face.begin(),
                   [](char in, char out) { return in > out ? 1 : 0; });
    note(up, face);
  }
  ++slice_;
}

void FlatFaceFinder::note(bool up, const Mask& face) {
  const auto voxels = static_cast<double>(std::count(face.begin(), face.end(), 1));
  if (voxels < least_px * least_px / 2) return;
  const double width = width_px(face, grid_.nx, grid_.ny);
  const double voxel = grid_.voxel_mm;
  if (width >= least_px) faces_.push_back({grid_.z_mm(slice_ - 0.5), up, width * voxel, voxels * voxel * voxel});
}

}  // namespace vam::light

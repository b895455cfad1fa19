// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/dose_grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "model/magnification.hpp"
#include "optics/chief_ray.hpp"
#include "optics/writable_radius.hpp"

namespace vam::light {

model::Grid dose_grid(const model::Printer& printer, const model::StackInfo& info, std::optional<double> size_mm) {
  const bool parallel = info.space == model::Space::virtual_;
  const double voxel_mm = info.row_mm > 0 ? info.row_mm : info.pixel_mm;
  if (parallel && !(std::abs(voxel_mm / info.pixel_mm - 1) < 1e-3)) {
    throw Error{Fault::data, "sinogram: its slices are " + mm_text(voxel_mm) + " apart, its columns " +
                                 mm_text(info.pixel_mm) + "; they must be equal, because voxels are cubes"};
  }
  const double all = parallel ? info.width * info.pixel_mm : 2 * optics::reach_mm(optics::projector_view(printer));
  const int n = std::max(1, ceil_int(size_mm.value_or(all) / voxel_mm - 1e-6));
  // Slices that pass the rows in some pose.
  const model::LiftRange lift = model::lift_mm(info.poses);
  const double slice_mm = voxel_mm * model::vertical_magnification(printer);
  const int below = ceil_int(std::max(0.0, lift.most) / slice_mm - 1e-6);
  const int above = ceil_int(std::max(0.0, -lift.least) / slice_mm - 1e-6);
  return model::centred_grid(n, n, below + info.count + above, voxel_mm, info.z_start_mm - below * voxel_mm);
}

int first_slice(const model::Grid& grid, const model::StackInfo& info) {
  const double pitch_mm = info.row_mm > 0 ? info.row_mm : grid.voxel_mm;
  const double place = (info.z_start_mm - grid.origin_mm[2]) / grid.voxel_mm;
  const double drift = info.count * std::abs(pitch_mm / grid.voxel_mm - 1);
  const int first = round_int(place);
  // A hundredth of a voxel: rounding, not another grid.
  if (drift > 0.01 || std::abs(place - first) > 0.01 || first < 0 || first + info.count > grid.nz) {
    throw Error{Fault::data, "sinogram: " + std::to_string(info.count) + " slices of " + mm_text(pitch_mm) +
                                 " from z = " + mm_text(info.z_start_mm) + " are not slices of the volume, " +
                                 std::to_string(grid.nz) + " of " + mm_text(grid.voxel_mm) +
                                 " from z = " + mm_text(grid.origin_mm[2])};
  }
  return first;
}

}  // namespace vam::light

// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/face_blur.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "model/magnification.hpp"
#include "optics/skew_ray.hpp"

namespace vam::light {

namespace {

double climb_at(const model::Printer& printer, double z_mm) {
  return std::abs(optics::skew_ray(optics::projector_view(printer), 0, z_mm).climb);
}

}  // namespace

double blur_voxels(const model::Printer& printer, const FlatFace& face, double voxel_mm) {
  return climb_at(printer, face.z_mm) * face.width_mm / (voxel_mm * model::vertical_magnification(printer));
}

double best_lift_mm(const model::Printer& printer, const std::vector<FlatFace>& faces, double voxel_mm, double least_mm,
                    double most_mm) {
  const auto suffering = [&](double lift_mm) {
    double sum = 0;
    for (FlatFace face : faces) {
      face.z_mm += lift_mm;
      const double smear = blur_voxels(printer, face, voxel_mm);
      sum += face.area_mm2 * smear * smear;
    }
    return sum;
  };
  constexpr double rounding = 1e-6;
  const int first = ceil_int(least_mm / voxel_mm - rounding);
  const int last = std::max(first, floor_int(most_mm / voxel_mm + rounding));
  int best = std::clamp(0, first, last);
  double least = suffering(best * voxel_mm);
  const auto look = [&](int from, int to, int step) {
    for (int lift = std::max(first, from); lift <= std::min(last, to); lift += step) {
      const double now = suffering(lift * voxel_mm);
      if (now >= least * (1 - rounding)) continue;
      least = now;
      best = lift;
    }
  };
  const int coarse = std::max(1, (last - first) / 64);
  look(first, last, coarse);
  look(best - coarse, best + coarse, 1);
  return best * voxel_mm;
}

}  // namespace vam::light

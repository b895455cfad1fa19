// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/blurred_faces.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/constants.hpp"
#include "base/index.hpp"
#include "model/magnification.hpp"
#include "optics/skew_ray.hpp"

namespace vam::light {

namespace {

std::int64_t wrong_near(const model::Grid& grid, std::span<const std::int64_t> wrong, double z_mm, double within) {
  const double at = (z_mm - grid.origin_mm[2]) / grid.voxel_mm;
  const auto slice = [&](double k) {
    return static_cast<std::ptrdiff_t>(std::clamp(k, 0.0, static_cast<double>(wrong.size())));
  };
  return std::accumulate(wrong.begin() + slice(std::ceil(at - within)),
                         wrong.begin() + slice(std::floor(at + within) + 1), std::int64_t{0});
}

}  // namespace

std::vector<BlurredFace> blurred_faces(const model::Printer& printer, const model::Grid& grid,
                                       std::span<const std::int64_t> wrong, const std::vector<FlatFace>& faces) {
  std::vector<BlurredFace> hard;
  for (const FlatFace& face : faces) {
    const double smear = blur_voxels(printer, face, grid.voxel_mm);
    if (smear < 1) continue;
    const std::int64_t nearby = wrong_near(grid, wrong, face.z_mm, smear);
    if (nearby > 0) hard.push_back({face, smear, nearby});
  }
  return hard;
}

FaceRemedy face_remedy(const model::Printer& printer, const std::vector<FlatFace>& faces,
                       const std::vector<BlurredFace>& hard, double voxel_mm, double least_mm, double most_mm) {
  FaceRemedy remedy;
  remedy.lift_mm = best_lift_mm(printer, faces, voxel_mm, least_mm, most_mm);
  double climb = 0;
  for (const BlurredFace& one : hard) {
    FlatFace lifted = one.face;
    lifted.z_mm += remedy.lift_mm;
    remedy.blur_voxels = std::max(remedy.blur_voxels, blur_voxels(printer, lifted, voxel_mm));
    climb = std::max(climb, one.blur_voxels * voxel_mm / one.face.width_mm);
  }
  remedy.tilt_deg = std::ceil(std::atan(climb) * deg_per_rad);
  return remedy;
}

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

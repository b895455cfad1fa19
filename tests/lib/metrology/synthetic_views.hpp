// SPDX-License-Identifier: GPL-3.0-or-later
// Views of a known part in a known rig, rendered by the oracle: every pixel's ray is traced through glass and resin.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "base/compute/parallel.hpp"
#include "metrology/ost/views.hpp"
#include "model/printer.hpp"
#include "oracle/camera_views.hpp"
#include "solid/shapes/shapes.hpp"

namespace vam::test {

inline model::Printer glass_rig() {
  model::Printer printer;
  printer.vial = {.radius_mm = 12.7, .wall_mm = 1, .index_glass = 1.52};
  printer.camera.distance_mm = 200;
  printer.camera.index_resin = 1.50;
  printer.camera.azimuth_deg = 90;
  return printer;
}

inline vam::oracle::CameraBench camera_bench(const model::Printer& printer, int columns, int rows, double pixel_mm) {
  vam::oracle::CameraBench camera;
  camera.bench.lens_distance = printer.camera.distance_mm;
  camera.bench.bath = 1;
  camera.bench.cylinders = {{printer.vial.radius_mm, printer.vial.index_glass},
                            {printer.vial.radius_mm - printer.vial.wall_mm, printer.camera.index_resin}};
  camera.columns = columns;
  camera.rows = rows;
  camera.pixel_mm = pixel_mm;
  camera.axis_column = 0.5 * (columns - 1);
  camera.azimuth_deg = printer.camera.azimuth_deg;
  return camera;
}

/// How finely the oracle sums: rays in steps of step_mm, within reach_mm of the axis.
struct Summing {
  double step_mm = 0.1;
  double reach_mm = 7;
};

/// Noise is Gaussian, seeded, its deviation in the units of the views.
inline std::vector<metrology::CameraView> take_views(const vam::oracle::CameraBench& camera,
                                                     const vam::oracle::Density& density,
                                                     const std::vector<double>& angles_deg, double noise, int binning,
                                                     const Summing& summing = {}) {
  const vam::oracle::Camera eye(camera, summing.step_mm, summing.reach_mm);
  std::vector<metrology::CameraView> views(angles_deg.size());
  parallel_for(static_cast<int>(views.size()), [&](int i) {
    Image raw(camera.columns, camera.rows);
    raw.values = eye.view(density, angles_deg[i]);
    std::mt19937 random(static_cast<unsigned>(i) + 1);
    std::normal_distribution<float> normal(0, static_cast<float>(noise));
    if (noise > 0) {
      for (float& value : raw.values) value += normal(random);
    }
    views[i] = {metrology::corrected(raw, {}, binning, "view"), angles_deg[i]};
  });
  return views;
}

inline std::vector<double> even_angles(int count) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) angles.push_back(360.0 * i / count);
  return angles;
}

/// Scattering density 1 inside a solid and 0 outside, looked up at the nearest point of a fine lattice: the solid moves
/// by less than pitch / sqrt(12) at random.
class FineDensity {
 public:
  FineDensity(const solid::Field& field, double pitch_mm) : pitch_mm_(pitch_mm), low_(field.box.low) {
    for (std::size_t d = 0; d < 3; ++d)
      count_[d] = 1 + static_cast<long>(std::ceil((field.box.high[d] - field.box.low[d]) / pitch_mm));
    inside_.resize(static_cast<std::size_t>(count_[0] * count_[1] * count_[2]));
    parallel_for(static_cast<int>(count_[2]), [&](int k) {
      std::size_t at = static_cast<std::size_t>(k * count_[0] * count_[1]);
      for (long j = 0; j < count_[1]; ++j) {
        for (long i = 0; i < count_[0]; ++i, ++at) {
          inside_[at] = field.value({low_[0] + pitch_mm * static_cast<double>(i),
                                     low_[1] + pitch_mm * static_cast<double>(j), low_[2] + pitch_mm * k}) < 0
                            ? 1
                            : 0;
        }
      }
    });
  }

  double operator()(double x, double y, double z) const {
    const auto i = static_cast<long>((x - low_[0]) / pitch_mm_ + 0.5);
    const auto j = static_cast<long>((y - low_[1]) / pitch_mm_ + 0.5);
    const auto k = static_cast<long>((z - low_[2]) / pitch_mm_ + 0.5);
    if (i < 0 || j < 0 || k < 0 || i >= count_[0] || j >= count_[1] || k >= count_[2]) return 0;
    return inside_[(k * count_[1] + j) * count_[0] + i];
  }

 private:
  double pitch_mm_;
  Vector3 low_;
  std::array<long, 3> count_{};
  std::vector<unsigned char> inside_;
};

}  // namespace vam::test

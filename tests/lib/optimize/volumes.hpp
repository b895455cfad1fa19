// SPDX-License-Identifier: GPL-3.0-or-later
// A volume optimised in memory, as vam-optimize does it, and the dose of its projections.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "lib/optimize/parts.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/run/shown.hpp"
#include "optimize/run/volume.hpp"

namespace volumes {

using namespace vam::optimize;
using vam::Slab;

inline constexpr int size = 64;
inline constexpr int angles = 90;

struct Written {
  std::vector<vam::Image> images;
  VolumeOutcome outcome;
  VolumeOutcome print;  // of these images, all slices, at the threshold
};

inline Written run(const std::vector<std::vector<float>>& slices, VolumeTask task = {}) {
  const auto made = parts::parallel_light(size, angles);
  const vam::light::Operator& light = *made;
  Written result;
  task.source.slices = static_cast<int>(slices.size());
  if (task.circle.radius == 0) task.circle = parts::circle(size);
  task.source.target = [&](int k, int count, float* out) {
    for (int i = 0; i < count; ++i) out = std::copy(slices[k + i].begin(), slices[k + i].end(), out);
  };
  if (!task.make) task.make = [](double) { return make_method("dose-norm", {}); };
  task.write = [&](int k, const vam::Image& image) {
    CHECK(k == static_cast<int>(result.images.size()) + (task.slices ? task.slices->from : 0));
    result.images.push_back(image);
  };
  result.outcome = optimise(task, light);
  if (!task.slices) result.print = prints_at(task, light, result.images, {{task.demands.window.threshold()}}).front();
  return result;
}

inline std::vector<float> dose_of(const vam::Image& image) {
  const auto turn = parts::turn(size, angles);
  Slab sinogram(size, angles);
  vam::pack(image.values.data(), 1, sinogram);
  Slab dose(size, size);
  vam::tomo::adjoint(turn, {&sinogram, 1}, {&dose, 1});
  std::vector<float> values(size * size);
  vam::unpack(dose, 1, values.data());
  for (float& v : values) v *= static_cast<float>(turn.angle_step_rad);
  return values;
}

/// Mean of IoU + PW over the slices, PW in parts of the threshold at which a slice prints best.
inline double quality(const std::vector<std::vector<float>>& slices, const std::vector<vam::Image>& images) {
  double sum = 0;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    const auto problem = parts::make_problem(slices[k].data(), 1, size, size, parts::circle(size), {});
    Slab dose(size, size);
    vam::pack(dose_of(images[k]).data(), 1, dose);
    const auto m = metrics({&dose, 1}, problem)[0];
    sum += m.iou + m.pw / m.iou_threshold;
  }
  return sum / static_cast<double>(slices.size());
}

}  // namespace volumes

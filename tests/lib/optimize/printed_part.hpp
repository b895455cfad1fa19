// SPDX-License-Identifier: GPL-3.0-or-later
// What the printability bench and its test share: a test part, optimised and then judged by chief rays.
#pragma once

#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "light/operators/make_operator.hpp"
#include "light/simulation/simulation.hpp"
#include "model/circle.hpp"
#include "optics/resample_stack.hpp"
#include "optics/writable_radius.hpp"
#include "optimize/methods/automatic.hpp"
#include "optimize/run/slice_figures.hpp"
#include "optimize/run/volume.hpp"
#include "solid/shapes/shapes.hpp"
#include "tomo/fbp.hpp"

namespace parts {

/// The shapes of the table, by the catalogue's names.
inline const std::vector<std::string>& printed_shapes() {
  static const std::vector<std::string> all{"gyroid", "ball-in-cage", "octet", "disc-grid", "hollow-cylinder", "boat"};
  return all;
}

struct Part {
  vam::model::Grid grid;
  std::vector<float> voxels;
};

/// `size` voxels along the largest of the part's height and diameter, with void all around.
inline Part make_part(const std::string& shape, int size) {
  const auto field = vam::solid::make_shape(shape);
  const double height = field.box.high[2] - field.box.low[2];
  const double voxel = std::max(2 * field.radius_mm, height) / (size - 2);
  const auto count = [&](double length) { return static_cast<int>(std::ceil(length / voxel - 1e-9)) + 2; };
  const int n = count(2 * field.radius_mm);
  const int nz = count(height);
  Part part{vam::model::centred_grid(n, n, nz, voxel, -0.5 * (nz - 1) * voxel), {}};
  part.voxels.resize(part.grid.size());
  vam::solid::cover(field, part.grid, 0, nz, part.voxels.data());
  return part;
}

struct Light {
  std::vector<vam::Image> sinograms;
  vam::model::StackInfo info;
  int iterations = 0;
  double seconds = 0;
};

inline vam::model::StackInfo stack_info(const Part& part, int angles) {
  vam::model::StackInfo info;
  info.height = angles;
  info.count = part.grid.nz;
  info.row_mm = part.grid.voxel_mm;
  info.z_start_mm = part.grid.z_mm(0);
  info.angle_step_deg = 360.0 / angles;
  return info;
}

/// All resin that is constrained and judged.
inline vam::model::Circle judged_circle(const Part& part, const vam::model::Printer& printer) {
  double farthest = 0;
  for (std::size_t v = 0; v < part.voxels.size(); ++v) {
    if (part.voxels[v] <= vam::model::coverage_rounding) continue;
    const auto at = static_cast<int>(v % part.grid.slice_size());
    farthest = std::max(farthest, std::hypot(part.grid.x_mm(at % part.grid.nx), part.grid.y_mm(at / part.grid.nx)));
  }
  return vam::model::writable_circle(part.grid, vam::optics::judged_radius_mm(printer, farthest));
}

/// Projector's light for the part. `method` as vam-optimize takes it; resampled: by way of parallel light; not limited:
/// neither in intensity nor by the surface, for the widest window.
inline Light make_light(const Part& part, const vam::model::Printer& printer, int angles, const std::string& method,
                        bool resampled, bool limited = true) {
  using namespace vam::optimize;
  using namespace vam::light;
  const bool automatic = method == "auto";
  const std::string name = automatic ? automatic_method : method;
  VolumeTask task;
  task.source.slices = part.grid.nz;
  task.circle = judged_circle(part, printer);
  task.make = [&](double max_intensity) {
    MethodOptions options;
    options.max_intensity = max_intensity;
    return make_method(name, options);
  };
  task.demands.free_surface = !limited;
  if (automatic && limited) {
    task.limit.of_even = usual_of_even;
    task.raising = usual_raising;
  }
  task.limits.iterations = method_entry(name).iterations;
  if (automatic) {
    task.limits.until = vam::model::parse_conditions(automatic_until, SliceFigures::names());
    task.limits.at_least = automatic_iterations;
    task.limits.least_rate = automatic_rate;
  }
  task.source.target = [&](int k, int count, float* out) {
    const std::size_t slice = part.grid.slice_size();
    std::copy_n(part.voxels.data() + static_cast<std::size_t>(k) * slice, static_cast<std::size_t>(count) * slice, out);
  };
  Light light;
  light.info = stack_info(part, angles);
  task.write = [&](int, const vam::Image& image) { light.sinograms.push_back(image); };
  const auto start = std::chrono::steady_clock::now();
  std::unique_ptr<Operator> how;
  if (resampled) {
    const int columns = vam::tomo::columns_across(task.circle, part.grid.nx);
    how = make_operator(ParallelBeam{vam::tomo::full_turn(part.grid, angles, columns)});
    light.info.width = columns;
    light.info.pixel_mm = part.grid.voxel_mm;
  } else {
    how = make_operator(vial_setup(printer, part.grid, angles, task.circle.radius * part.grid.voxel_mm));
    light.info.space = vam::model::Space::projector;
    light.info.width = printer.projector.columns;
    light.info.pixel_mm = printer.projector.pixel_mm;
  }
  light.iterations = optimise(task, *how).iterations;
  if (resampled) {
    vam::optics::ResampleOptions cubic;
    cubic.keep_negative = false;
    const auto job = vam::optics::stack_to_projector(printer, {}, light.info, cubic);
    std::vector<vam::Image> bent(light.sinograms.size());
    vam::optics::resample(job.plan, light.sinograms, bent);
    light.sinograms = std::move(bent);
    light.info = job.info;
  }
  light.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return light;
}

/// Of the whole part, by metrology's chief rays; voxels that the surface cuts are left out.
inline vam::model::DoseMetrics judge(const Part& part, const vam::model::Printer& printer, const Light& light) {
  const vam::light::Simulation simulation(printer, {}, light.info, part.grid);
  const auto circle = judged_circle(part, printer);
  std::vector<vam::Image> doses(light.sinograms.size());
  simulation.dose(light.sinograms, doses);
  vam::model::DoseStatistics statistics;
  const float* coverage = part.voxels.data();
  for (const auto& dose : doses) {
    for (int y = 0; y < part.grid.ny; ++y) {
      for (int x = 0; x < part.grid.nx; ++x, ++coverage) {
        const auto label = vam::model::label_of(*coverage);
        if (label == vam::model::Label::part || circle.contains(x, y)) statistics.add(dose(x, y), label);
      }
    }
  }
  return statistics.metrics();
}

}  // namespace parts

// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/preview.hpp"

#include <algorithm>
#include <numbers>

#include "light/grids/lit_grid.hpp"
#include "light/operators/make_operator.hpp"
#include "light/rays/vial_setup.hpp"
#include "model/conditions.hpp"
#include "model/dose/dose_spread.hpp"
#include "optimize/methods/automatic.hpp"
#include "optimize/methods/method.hpp"
#include "optimize/run/slice_figures.hpp"

namespace vam::optimize {

namespace {

constexpr int most_iterations = 60;
constexpr double most_updates = 1e10;  // voxels x angles x iterations: a projection of 2e8 takes 0.1 s

/// The target within the grid of all that its light reaches.
model::Volume extended(const model::Volume& target, const light::Margin& margin) {
  model::Volume wide{light::extended(target.grid, margin), {}};
  wide.values.assign(wide.grid.size(), 0.0F);
  for (int k = 0; k < target.grid.nz; ++k)
    light::place_slice(target.slice(k), target.grid, margin, wide.slice(k + margin.below));
  return wide;
}

}  // namespace

Preview preview(const PreviewTask& wanted) {
  const light::Margin margin = light::lit_margin(wanted.printer, wanted.target.grid, wanted.radius_mm);
  const model::Volume lit = extended(wanted.target, margin);
  VolumeTask task;
  task.source.slices = lit.grid.nz;
  task.source.target = [&](int k, int count, float* out) {
    std::copy_n(lit.slice(k), static_cast<std::size_t>(count) * lit.grid.slice_size(), out);
  };
  task.circle = model::writable_circle(lit.grid, wanted.radius_mm);
  task.part = light::moved(wanted.part, margin);
  task.limits.at_least = wanted.iterations;
  const double updates = static_cast<double>(lit.grid.size()) * wanted.angles;  // an iteration's
  task.limits.iterations = std::clamp(static_cast<int>(most_updates / updates), wanted.iterations,
                                      std::max(wanted.iterations, most_iterations));
  task.limits.until = model::parse_conditions(automatic_until, SliceFigures::names());
  task.limits.least_rate = automatic_rate;
  task.limits.leaves_open = true;
  task.limits.patience = 0;
  task.limit.of_even = usual_of_even;
  task.raising = usual_raising;
  const auto blur_of = [&](const model::Resin& resin, double seconds) {
    return model::spread_mm(resin, seconds) / lit.grid.voxel_mm;
  };
  const auto blur_px = [&](double seconds) { return blur_of(wanted.printer.resin, seconds); };
  task.blur_px = blur_px(model::seconds_of(wanted.printer.stage, wanted.printer.stage.turns));
  task.make = [](double max_intensity) {
    MethodOptions how;
    how.max_intensity = max_intensity;
    return method_entry(automatic_method).make(how);
  };
  const auto setup_for = [&](const model::Printer& printer, int print_angles) {
    auto setup = light::vial_setup(printer, lit.grid, wanted.angles, task.circle.radius * lit.grid.voxel_mm);
    setup.hold_rad = light::hold_rad(printer, 2 * std::numbers::pi / print_angles);
    return setup;
  };
  const auto setup_of = [&](const model::Printer& printer) { return setup_for(printer, wanted.print_angles); };
  const light::VialSetup setup = setup_of(wanted.printer);
  task.around = [&](std::span<const Slab> inserts) { return light::make_operator(setup, inserts); };
  Frames frames;
  task.write = [&](int, const Image& image) { frames.add(image); };
  const auto light = light::make_operator(setup);
  Preview made{lit.grid, optimise(task, *light), {}, {}, {}};
  const auto [threshold, seconds] = judge_shown(task, *light, frames, wanted.expose, blur_px, made.outcome);
  made.beside = prints_at(task, *light, frames,
                          {{(1 - verdict::dose_margin) * threshold, (1 + verdict::dose_margin) * threshold}});
  Trial trial{.printer = {wanted.printer, wanted.tolerances, setup_of,
                          [&, time_s = seconds](const model::Resin& resin) { return blur_of(resin, time_s); }},
              .grid = lit.grid,
              .threshold = threshold,
              .ends = true};
  made.trials = run_trials(trial, task, frames);
  for (const int angles : {120, 180, 240, 360, 720}) {
    if (setup.hold_rad == 0) break;
    trial.printer.setup = [&](const model::Printer& printer) { return setup_for(printer, angles); };
    const model::DoseMetrics held = print_as_set(trial, task, frames).figures;
    made.by_angles.emplace_back(angles, held.pw / held.max_dose);
  }
  return made;
}

}  // namespace vam::optimize

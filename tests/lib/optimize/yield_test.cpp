// SPDX-License-Identifier: GPL-3.0-or-later
// The printers that are drawn for the yield: the part is that of the printer as set.
#include "optimize/run/yield.hpp"

#include "model/magnification.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;

namespace {

constexpr int size = 9, slices = 41, angles = 24;
const model::Grid grid = model::centred_grid(size, size, slices, 0.25, -5);
constexpr double index_error = 0.2;

model::Printer near_printer() {
  model::Printer printer;
  printer.projector.lens_distance_mm = 60;
  return printer;
}

Trial trial_of(const model::Printer& printer) {
  Trial trial;
  trial.printer = {printer,
                   {},
                   [](const model::Printer& off) { return light::vial_setup(off, grid, angles, 0); },
                   [](const model::Resin&) { return 0.0; }};
  trial.printer.tolerances[static_cast<std::size_t>(model::ToleranceKind::index)] = index_error;
  trial.grid = grid;
  return trial;
}

/// The dose on the axis in that slice, which its own row alone lights, where the index is that much lower.
double dose_of_own_row(const Trial& trial, int lit) {
  VolumeTask task;
  task.source.slices = slices;
  task.source.target = [&](int k, int count, float* out) {
    std::fill_n(out, static_cast<std::size_t>(count) * size * size, 0.0F);
    if (k <= lit && lit < k + count) out[(lit - k) * size * size + size * size / 2] = 1;
  };
  task.circle = {0.5 * (size - 1), 0.5 * (size - 1), 0.5 * size};
  std::vector<Image> frames(slices, Image(trial.printer.printer.projector.columns, angles));
  std::fill(frames[lit].values.begin(), frames[lit].values.end(), 1.0F);
  return run_trials(trial, task, frames).singles.at(0).minus.figures.min_part;
}

}  // namespace

TEST_CASE("an index off its setting moves the light along the axis, not the part") {
  const model::Printer printer = near_printer();
  const Trial trial = trial_of(printer);
  constexpr int top = slices - 3, middle = slices / 2;
  model::Printer off = printer;
  off.resin.index -= index_error;
  const double moved = (model::vertical_magnification(off) / model::vertical_magnification(printer) - 1) *
                       grid.z_mm(top) / grid.voxel_mm;
  REQUIRE(moved > 0.3);
  // Light between two rows is theirs in proportion; skew rays lose a little more at the interfaces.
  CHECK(dose_of_own_row(trial, top) / dose_of_own_row(trial, middle) == doctest::Approx(1 - moved).epsilon(0.03));
}

// SPDX-License-Identifier: GPL-3.0-or-later
// The working curve of scattering, on the simulated resin, whose kinetics are other equations than those of the fit.
#include "metrology/cure/curing_curve.hpp"

#include "lib/curing_bench.hpp"
#include "light/simulation/simulation.hpp"
#include "metrology/ost/ost.hpp"
#include "model/magnification.hpp"
#include "resin/absolute_dose.hpp"
#include "sim/bench/print.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

struct Truth {
  sim::SimResin resin;
  double turn_s = 12;
  int turns = 9;
  int lit_turns = 9;
  double noise = 0.01;  // of the saturation, in a reading
};

/// A staircase of eight doses, one voxel each, over the turns; readings are of the middle of a turn.
std::vector<metrology::CuringReading> staircase(const Truth& truth, unsigned seed) {
  constexpr int steps = 8;
  sim::Photoresin resin(truth.resin, model::centred_grid(1, 1, steps, 1));
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, truth.noise);
  std::vector<metrology::CuringReading> readings;
  constexpr int parts = 600;  // a step late by 0.02 s
  for (int turn = 0; turn < truth.turns; ++turn) {
    std::vector<double> seen(steps);
    for (int part = 0; part < parts; ++part) {
      for (int k = 0; k < steps; ++k) {
        const double per_turn = truth.resin.critical_dose_mj_cm3 * (0.08 + 0.03 * k);
        if (turn < truth.lit_turns) resin.absorbed()[k] += static_cast<float>(per_turn / parts);
      }
      resin.react(truth.turn_s / parts);
      if (part != parts / 2) continue;
      for (int k = 0; k < steps; ++k) seen[k] = static_cast<double>(resin.scatter().values[k]);
    }
    for (int k = 0; k < steps; ++k) {
      const double per_turn = truth.resin.critical_dose_mj_cm3 * (0.08 + 0.03 * k);
      readings.push_back({per_turn, turn + 0.0, turn + 1.0, 0.08 * (seen[k] + normal(random)), 0.08 * truth.noise});
    }
  }
  return readings;
}

Truth drawn(unsigned seed) {
  std::mt19937_64 random(1000 + seed);
  const auto between = [&random](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Truth truth;
  truth.resin.critical_dose_mj_cm3 = between(30, 120);
  truth.resin.induction = between(0.2, 0.7);
  truth.resin.delay_s = between(1, 8);
  truth.resin.inhibitor_diffusion_mm2_s = 0;
  return truth;
}

constexpr int angles = 60;

/// Six bands of six rows, each brighter than the one below, all around.
GreyImage bands(const model::Projector& projector) {
  GreyImage frame(projector.columns, projector.rows, 8);
  for (int r = 4; r < 40; ++r) {
    for (int c = 18; c < 46; ++c) frame(c, r) = static_cast<std::uint16_t>(100 + 25 * ((39 - r) / 6));
  }
  return frame;
}

/// The planner's dose of a turn of it, mJ/cm3, in its stretched frame.
model::Volume planned_dose(const model::Printer& printer, const GreyImage& frame) {
  model::StackInfo info;
  info.space = model::Space::projector;
  info.width = frame.width;
  info.height = angles;
  info.count = frame.height;
  info.pixel_mm = info.row_mm = printer.projector.pixel_mm;
  info.z_start_mm = -(frame.height - 1 - printer.projector.axis_row) * info.row_mm;
  info.angle_step_deg = 360.0 / angles;
  std::vector<Image> rows(frame.height, Image(frame.width, angles));
  for (const auto [r, a, c] : indices(frame.height, angles, frame.width)) {
    rows[frame.height - 1 - r](c, a) = static_cast<float>(frame(c, r)) / 255.0F;
  }
  const model::Grid grid = model::centred_grid(36, 36, 42, 0.2, -4.1);
  std::vector<Image> slices(grid.nz);
  light::Simulation(printer, {}, info, grid).dose(rows, slices);
  model::Volume dose{grid, {}};
  const auto per_radian = static_cast<float>(*resin::dose_per_radian_mj_cm3(printer));
  for (const Image& slice : slices) {
    for (const float value : slice.values) dose.values.push_back(per_radian * value);
  }
  return dose;
}

}  // namespace

TEST_CASE("The working curve finds critical dose and delay of simulated resins within its sigmas") {
  constexpr unsigned seeds = 24;
  int dose_within = 0;
  int delay_within = 0;
  double bias = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const Truth truth = drawn(seed);
    const auto curve = metrology::fit_curing_curve(staircase(truth, seed), 1e9, std::nullopt);
    REQUIRE(curve.delay_turns);
    const double off = curve.critical_dose_mj_cm3.value / truth.resin.critical_dose_mj_cm3 - 1;
    const double delay_off = curve.delay_turns->value * truth.turn_s - truth.resin.delay_s;
    bias += off / seeds;
    dose_within += std::abs(off) * truth.resin.critical_dose_mj_cm3 < 2 * curve.critical_dose_mj_cm3.sigma ? 1 : 0;
    delay_within += std::abs(delay_off) < 2 * curve.delay_turns->sigma * truth.turn_s ? 1 : 0;
  }
  CHECK(dose_within >= 21);  // of 24 at 95 %: 23, less than 21 in one of 30 cases
  CHECK(delay_within >= 21);
  CHECK(std::abs(bias) < 0.005);
}

TEST_CASE("The delay of a prompt resin is none, within its sigma") {
  Truth truth;
  truth.resin.critical_dose_mj_cm3 = 60;
  truth.resin.delay_s = 0;
  truth.resin.inhibitor_diffusion_mm2_s = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    const auto curve = metrology::fit_curing_curve(staircase(truth, seed), 1e9, std::nullopt);
    REQUIRE(curve.delay_turns);
    CHECK(std::abs(curve.delay_turns->value) < 3 * curve.delay_turns->sigma);
  }
}

TEST_CASE("A working curve whose light went off earlier than stated is refused") {
  for (unsigned seed = 0; seed < 8; ++seed) {
    Truth truth = drawn(seed);
    truth.turns = 9;
    truth.lit_turns = 5;
    const auto readings = staircase(truth, seed);
    const auto curve = metrology::fit_curing_curve(readings, truth.lit_turns, std::nullopt);
    CHECK(curve.critical_dose_mj_cm3.value == doctest::Approx(truth.resin.critical_dose_mj_cm3).epsilon(0.05));
    CHECK(fault_of([&] { (void)metrology::fit_curing_curve(readings, 1e9, std::nullopt); }) == Fault::data);
  }
}

TEST_CASE("A working curve of the end of a print has no delay, and the dose at an isovalue that is given") {
  std::vector<metrology::CuringReading> readings;
  for (int k = 0; k < 16; ++k) {  // logistic, long after 4 turns of light
    const double per_turn = 5 + k;
    const double scatter = 0.08 / (1 + std::exp((50 - 4 * per_turn) / 4));
    readings.push_back({per_turn, 9, 10, scatter, 0.0001});
  }
  const auto half = metrology::fit_curing_curve(readings, 4, std::nullopt);
  CHECK_FALSE(half.delay_turns);
  CHECK(half.isovalue == doctest::Approx(0.04).epsilon(1e-4));
  CHECK(half.critical_dose_mj_cm3.value == doctest::Approx(50).epsilon(1e-4));
  CHECK(half.induction_dose_mj_cm3.value == doctest::Approx(42).epsilon(1e-3));
  CHECK(half.rate_per_mj_cm3.value == doctest::Approx(1.0 / 16).epsilon(1e-3));
  const auto lower = metrology::fit_curing_curve(readings, 4, 0.02);
  CHECK(lower.critical_dose_mj_cm3.value == doctest::Approx(50 - 4 * std::log(3.0)).epsilon(1e-3));
  CHECK(fault_of([&] { (void)metrology::fit_curing_curve(readings, 4, 0.1); }) == Fault::data);
  readings.resize(7);  // none above three quarters
  CHECK(fault_of([&] { (void)metrology::fit_curing_curve(readings, 4, std::nullopt); }) == Fault::data);
  CHECK(fault_of([&] { (void)metrology::fit_curing_curve({}, 4, std::nullopt); }) == Fault::data);
}

TEST_CASE("Readings of a working curve are the steps of a staircase, whose heights are stretched; edges are none") {
  model::Volume scatter{model::centred_grid(20, 20, 36, 0.2, -3.5), {}};
  model::Volume dose{model::centred_grid(30, 30, 80, 0.15, -5.925), {}};
  scatter.values.resize(scatter.grid.size());
  dose.values.resize(dose.grid.size());
  constexpr double stretch = 1.05;
  for (int k = 0; k < dose.grid.nz; ++k) {  // three steps of 2 mm of the print
    const int step = std::clamp(static_cast<int>(std::floor(dose.grid.z_mm(k) / stretch / 2 + 1.5)), 0, 2);
    std::fill_n(dose.slice(k), dose.grid.slice_size(), static_cast<float>(10 + 10 * step));
  }
  for (int k = 0; k < scatter.grid.nz; ++k) {
    const int step = std::clamp(static_cast<int>(std::floor(scatter.grid.z_mm(k) / 2 + 1.5)), 0, 2);
    std::fill_n(scatter.slice(k), scatter.grid.slice_size(), 0.01F * static_cast<float>(step * step));
  }
  const auto readings = metrology::curing_readings(scatter, dose, stretch, 16, 2, 3);
  REQUIRE(readings.size() == 3);
  for (int step = 0; step < 3; ++step) {
    CHECK(readings[step].dose_per_turn_mj_cm3 == doctest::Approx(10 + 10 * step).epsilon(1e-6));
    CHECK(readings[step].scatter == doctest::Approx(0.01 * step * step).epsilon(1e-5));
    CHECK(readings[step].last_turn == 3);
  }
}

TEST_CASE("Readings of a working curve are of voxels without a step on either side, which views blur") {
  model::Volume dose{model::centred_grid(12, 12, 31, 0.2), {}};
  dose.values.resize(dose.grid.size());
  model::Volume scatter = dose;
  const auto of_dose = [](int k) { return 10.0F + 10.0F * static_cast<float>(std::clamp(k / 10, 0, 2)); };
  for (int k = 0; k < dose.grid.nz; ++k) {
    std::fill_n(dose.slice(k), dose.grid.slice_size(), of_dose(k));
    const float blurred = 0.25F * (of_dose(k - 1) + 2 * of_dose(k) + of_dose(k + 1));
    std::fill_n(scatter.slice(k), scatter.grid.slice_size(), 0.001F * blurred);
  }
  const auto readings = metrology::curing_readings(scatter, dose, 1, 16, 2, 3);
  REQUIRE(readings.size() == 3);
  for (int step = 0; step < 3; ++step) {
    CHECK(readings[step].scatter == doctest::Approx(0.01 * (step + 1)).epsilon(1e-5));
    CHECK(readings[step].sigma < 1e-6);
  }
}

TEST_CASE("A working curve by planned doses and reconstructed views has the critical dose of the simulated vial") {
  sim::SimBench bench;
  auto& printer = bench.printer;
  printer = test::curing_printer();
  printer.projector.rows = 44;
  printer.projector.axis_row = 21.5;
  printer.projector.max_intensity_mw_cm2 = 3.5;
  printer.resin.absorption_per_mm = 0.06;
  printer.resin.critical_dose_mj_cm3 = 60;
  printer.camera.pixel_mm = 0.15;
  bench.columns = 90;
  bench.rows = 68;
  bench.noise = 0.002;
  bench.resin = sim::SimResin{};
  sim::SimPrint print(bench);
  const sim::SimScene scene(bench, 1, 16);
  const GreyImage frame = bands(printer.projector);
  const std::vector<GreyImage> frames(angles, frame);
  const model::Volume dose = planned_dose(printer, frame);
  metrology::OstOptions how{.growing = true};
  const metrology::OstReconstructor rig(printer, printer.camera.pixel_mm, bench.columns, bench.rows,
                                        {0.5 * (bench.columns - 1), 0}, how);
  std::vector<metrology::CuringReading> readings;
  for (int turn = 0; turn < 9; ++turn) {
    std::vector<metrology::CameraView> views;
    for (const sim::SimView& seen : sim::play_turn(bench, scene, print, frames, angles, angles * turn)) {
      Image image(seen.levels.width, seen.levels.height);
      for (std::size_t p = 0; p < image.size(); ++p) {
        image.values[p] = static_cast<float>(seen.levels.values[p]) / 65535.0F;
      }
      views.push_back({image, seen.angle_deg});
    }
    metrology::CleaningReport dirt;
    const model::Volume scatter = rig.reconstruct(views, &dirt);
    CHECK(dirt.flicker_percent < 10);  // 60 by growth from nothing
    const auto of_turn =
        metrology::curing_readings(scatter, dose, 1 / model::vertical_magnification(printer), 16, turn, turn + 1.0);
    readings.insert(readings.end(), of_turn.begin(), of_turn.end());
  }
  const auto curve = metrology::fit_curing_curve(readings, 1e9, std::nullopt);
  CHECK(std::abs(curve.critical_dose_mj_cm3.value - 60) < 2 * curve.critical_dose_mj_cm3.sigma);
  CHECK(curve.critical_dose_mj_cm3.sigma < 3);  // 5 %
  CHECK(std::abs(curve.delay_turns->value * 12 - 3) < 2 * curve.delay_turns->sigma * 12);
  CHECK(curve.saturation.value == doctest::Approx(0.08).epsilon(0.03));
}

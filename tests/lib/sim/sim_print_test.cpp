// SPDX-License-Identifier: GPL-3.0-or-later
// The simulated print against independent solvers: light against the deposition oracle, views against traced bodies,
// the resin against closed forms.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "lib/curing_bench.hpp"
#include "metrology/ost/ost.hpp"
#include "oracle/bench_views.hpp"
#include "oracle/deposited_dose.hpp"
#include "sim/bench/print.hpp"
#include "sim/bench/private/deposit.hpp"
#include "sim/bench/private/ray.hpp"
#include "sim/bench/private/sight_lines.hpp"
#include "sim/bench/world.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::sim;

namespace {

model::Printer small_printer() {
  model::Printer printer = test::curing_printer();
  printer.projector.rows = 24;
  printer.projector.axis_column = 30.5;
  printer.projector.axis_row = 17;
  printer.projector.max_intensity_mw_cm2 = 5;
  printer.resin.absorption_per_mm = 0.08;
  printer.resin.critical_dose_mj_cm3 = 40;
  printer.camera.pixel_mm = 0.12;
  return printer;
}

SimBench small_bench() {
  return {.printer = small_printer(), .columns = 110, .rows = 48, .background = 0, .resin = SimResin{}};
}

/// A resin of a few voxels without diffusion.
SimResin still_resin() { return {.critical_dose_mj_cm3 = 40, .inhibitor_diffusion_mm2_s = 0}; }

void expose(Photoresin& resin, double dose_mj_cm3, double seconds) {
  constexpr int steps = 400;
  for (int n = 0; n < steps; ++n) {
    for (float& dose : resin.absorbed()) dose += static_cast<float>(dose_mj_cm3 / steps);
    resin.react(seconds / steps);
  }
}

}  // namespace

TEST_CASE("A ray that climbs is the one of the vector tracer of the oracle") {
  const model::Printer printer = small_printer();
  const SimShells shells = outer_shells(printer, printer.resin.index);
  const oracle::Bench bench{90, 1, 0, {{6, 1.52L}, {5.5L, 1.49L}}};
  for (const double x_mm : {-4.0, 0.0, 5.0}) {
    for (const double z_mm : {-3.0, 0.0, 6.0}) {
      const ClimbingRay ray = climbing_ray(x_mm, z_mm, {90, 90}, shells);
      const auto truth = oracle::trace(bench, x_mm, z_mm);
      REQUIRE(ray.enters);
      REQUIRE(truth);
      for (std::size_t a = 0; a < 3; ++a) {
        CHECK(ray.at[a] == doctest::Approx(static_cast<double>(truth->point[a])).epsilon(1e-10));
        CHECK(ray.along[a] == doctest::Approx(static_cast<double>(truth->direction[a])).epsilon(1e-10));
      }
      CHECK(ray.transmittance == doctest::Approx(static_cast<double>(truth->transmittance)).epsilon(1e-10));
    }
  }
  CHECK_FALSE(climbing_ray(6.5, 0, {90, 90}, shells).enters);
}

TEST_CASE("The light of a turn in voxels is that of the deposition oracle") {
  const model::Printer printer = small_printer();
  const model::Grid grid = model::centred_grid(31, 31, 14, 0.25, -1.2);
  const Deposit deposit(printer, grid, 1, 0);
  constexpr int angles = 60;
  const double step_rad = 2 * std::numbers::pi / angles;
  std::vector<Image> rows(printer.projector.rows, Image(printer.projector.columns, angles));
  std::vector<float> dose(grid.size());
  for (int k = 0; k < angles; ++k) {
    GreyImage image(printer.projector.columns, printer.projector.rows, 8);
    for (int r = 8; r < 22; ++r) {
      for (int c = 14; c < 44; ++c) {  // a wedge that is brighter on one side, more so at some angles
        image(c, r) = static_cast<std::uint16_t>(60 + 4 * (c - 14) + (k < angles / 3 ? 60 : 0) + r);
        rows[r](c, k) = static_cast<float>(image(c, r)) / 255.0F;
      }
    }
    deposit.add(image, k * step_rad, 0, 5, 0.2, dose);
  }
  oracle::Deposit setup{{90, 1, 0, {{6, 1.52L}, {5.5L, 1.49L}}},
                        printer.projector.pixel_mm,
                        printer.projector.pixel_mm,
                        printer.projector.axis_column,
                        4,
                        printer.resin.absorption_per_mm,
                        angles,
                        0,
                        step_rad,
                        grid.nx,
                        grid.nz,
                        grid.voxel_mm,
                        grid.voxel_mm,
                        grid.origin_mm[2]};
  oracle::Deposited truth;
  truth.dose.resize(grid.size());
  for (int r = 0; r < printer.projector.rows; ++r) {
    oracle::deposit(setup, rows[r], (printer.projector.axis_row - r) * printer.projector.pixel_mm, truth);
  }
  const double per_radian = 5 * 10 * printer.resin.absorption_per_mm * 0.2 / step_rad;  // mJ/cm3 [CAL19 eq 1]
  double squares = 0;
  double sum = 0;
  double sum_of_truth = 0;
  for (std::size_t v = 0; v < dose.size(); ++v) {
    const double is = static_cast<double>(dose[v]);
    const double should = per_radian * truth.dose[v];
    squares += (is - should) * (is - should);
    sum += is;
    sum_of_truth += should;
  }
  const auto n = static_cast<double>(dose.size());
  CHECK(sum == doctest::Approx(sum_of_truth).epsilon(0.005));
  CHECK(std::sqrt(squares / n) < 0.03 * sum_of_truth / n);  // steps of 0.6 voxels at 60 angles
}

TEST_CASE("Resin gels with its critical dose: inhibitor first, light of any pace, growth after the light") {
  const model::Grid grid = model::centred_grid(2, 2, 2, 0.2);
  const auto end = [&](double dose, double seconds) {
    Photoresin resin(still_resin(), grid);
    expose(resin, dose, seconds);
    resin.react(60);
    return static_cast<double>(resin.conversion().values[0]);
  };
  for (const double seconds : {1.0, 60.0}) {
    CHECK(end(39.8, seconds) < 1);
    CHECK(end(40.2, seconds) > 1);
    CHECK(end(19, seconds) < 0.08);  // half is the inhibitor's; few radicals escape it
  }
  // 1 - e^-E/G, E beyond the induction dose, G so that 0.3 is reached at 40.
  const double growth = 20 / -std::log(0.7);
  CHECK(end(100, 10) == doctest::Approx((1 - std::exp(-80 / growth)) / 0.3).epsilon(1e-3));
  Photoresin quick(still_resin(), grid);
  expose(quick, 45, 0.01);
  CHECK(quick.conversion().values[0] < 0.01);  // radicals have hardly begun
  quick.react(3);
  const double later = 25 * (1 - std::exp(-1.0));
  CHECK(static_cast<double>(quick.conversion().values[0]) ==
        doctest::Approx((1 - std::exp(-later / growth)) / 0.3).epsilon(0.01));
  CHECK(quick.scatter().values[0] < 0.5);
  quick.react(60);
  CHECK(quick.scatter().values[0] > 0.5);
}

TEST_CASE("Inhibitor: its gradient delays the upper slices, diffusion brings it back") {
  SimResin about = still_resin();
  about.inhibition_gradient = 0.2;
  const model::Grid grid = model::centred_grid(1, 1, 3, 0.2);
  Photoresin resin(about, grid);
  expose(resin, 40, 10);
  resin.react(60);
  const auto conversion = resin.conversion().values;
  CHECK(conversion[0] > 1);
  CHECK(conversion[1] == doctest::Approx(1).epsilon(0.002));
  CHECK(conversion[2] < 1);
  // A lit voxel among dark ones cures more slowly where inhibitor comes in: through four faces 4 x 1e-3 / 0.2^2 of the
  // neighbours' a second, which takes 2 mJ/cm3 of the light's 1; of its 50 less than 5 escape, 30 without diffusion.
  const auto lit_alone = [&](double diffusion_mm2_s) {
    SimResin other = still_resin();
    other.inhibitor_diffusion_mm2_s = diffusion_mm2_s;
    Photoresin small(other, model::centred_grid(5, 5, 1, 0.2));
    for (int n = 0; n < 100; ++n) {
      small.absorbed()[12] += 0.5F;
      small.react(0.5);
    }
    return small.conversion().values[12];
  };
  CHECK(lit_alone(1e-3) < 0.2F * lit_alone(0));
}

TEST_CASE("A cured ball looks to the camera as the traced one, wherever it stands") {
  const model::Printer printer = small_printer();
  const model::Grid grid = model::centred_grid(61, 61, 41, 0.1, -2);
  Photoresin resin(still_resin(), grid);
  const std::array<double, 3> middle{1.2, -0.5, 0.3};
  for (const auto [k, j, i] : indices(grid.nz, grid.ny, grid.nx)) {
    const double away = std::hypot(grid.x_mm(i) - middle[0], grid.y_mm(j) - middle[1], grid.z_mm(k) - middle[2]);
    if (away < 1.5) resin.absorbed()[(k * grid.ny + j) * static_cast<std::size_t>(grid.nx) + i] = 1e4F;
  }
  resin.react(100);
  constexpr int columns = 90;
  constexpr int rows = 40;
  const SightLines lines(printer, columns, rows, 0.12);
  oracle::ViewBench bench{200, 0, 1, 6, 0.5, 1.52, 1.48, columns, rows, 0.12, 0.5 * (columns - 1), 0.5 * (rows - 1)};
  const auto truth = oracle::bench_views(bench, {{oracle::Body::Kind::ball, middle, {1.5, 1.5, 1.5}}}, {}, 6);
  for (std::size_t n = 0; n < truth.size(); ++n) {
    const Image seen = lines.view(resin, 2 * std::numbers::pi * static_cast<double>(n) / 6);
    double squares = 0;
    double all = 0;
    for (std::size_t p = 0; p < seen.size(); ++p) {
      const double off = static_cast<double>(seen.values[p]) - static_cast<double>(truth[n][p]);
      squares += off * off;
      all += static_cast<double>(truth[n][p]) * static_cast<double>(truth[n][p]);
    }
    CHECK(std::sqrt(squares / all) < 0.05);  // voxels of a fifteenth of its radius
  }
}

TEST_CASE("What light has cured is what vam-ost reconstructs from the views of a turn, dirt and all") {
  SimBench bench = small_bench();
  bench.specks = 3;
  bench.noise = 0.002;
  bench.resin->inhibition_gradient = 0.1;
  SimPrint print(bench);
  const SimScene scene(bench, 1, 16);
  GreyImage frame(bench.printer.projector.columns, bench.printer.projector.rows, 8);
  for (int r = 10; r < 22; ++r) {
    for (int c = 18; c < 43; ++c) frame(c, r) = 255;
  }
  const std::vector<GreyImage> lit(60, frame);
  const std::vector<GreyImage> dark(60, GreyImage(frame.width, frame.height, 8));
  std::vector<metrology::CameraView> views;
  for (int turn = 0; turn < 3; ++turn) {
    views.clear();
    for (const SimView& view : play_turn(bench, scene, print, turn < 2 ? lit : dark, 60, 60 * turn)) {
      Image image(view.levels.width, view.levels.height);
      for (std::size_t p = 0; p < image.size(); ++p) {
        image.values[p] = static_cast<float>(view.levels.values[p]) / 65535.0F;
      }
      views.push_back({image, view.angle_deg});
    }
  }
  CHECK(print.lit_s() == doctest::Approx(36));
  const metrology::OstReconstructor rig(bench.printer, bench.printer.camera.pixel_mm, bench.columns, bench.rows,
                                        {0.5 * (bench.columns - 1), 0}, {});
  const model::Volume seen = rig.reconstruct(views);
  const model::Volume& truth = print.resin().scatter();
  double agree = 0;
  double either = 0;
  for (int k = 1; k + 1 < truth.grid.nz; ++k) {
    for (const auto [j, i] : indices(truth.grid.ny, truth.grid.nx)) {
      const auto at = [&](double mm, double origin) {
        return static_cast<int>(std::lround((mm - origin) / seen.grid.voxel_mm));
      };
      const int x = at(truth.grid.x_mm(i), seen.grid.origin_mm[0]);
      const int y = at(truth.grid.y_mm(j), seen.grid.origin_mm[1]);
      const int z = at(truth.grid.z_mm(k), seen.grid.origin_mm[2]);
      if (x < 0 || y < 0 || z < 0 || x >= seen.grid.nx || y >= seen.grid.ny || z >= seen.grid.nz) continue;
      const bool solid = truth.slice(k)[j * truth.grid.nx + i] > 0.5F;
      const bool shown = seen.slice(z)[y * seen.grid.nx + x] > 0.04F;  // half of 0.08 per mm
      agree += solid && shown ? 1 : 0;
      either += solid || shown ? 1 : 0;
    }
  }
  CHECK(either > 500);
  CHECK(agree / either > 0.9);  // a voxel of 0.2 mm around a body of 5 mm is 0.85
}

TEST_CASE("Faults of the lamp and of the axis reach the resin") {
  SimBench bench = small_bench();
  GreyImage frame(bench.printer.projector.columns, bench.printer.projector.rows, 8);
  for (int r = 12; r < 20; ++r) frame(31, r) = 255;
  const auto converted = [&](const SimBench& about) {
    SimPrint print(about);
    for (int n = 0; n < 60; ++n) print.pass(&frame, 0, 1);
    const auto volume = print.resin().conversion();
    return std::accumulate(volume.values.begin(), volume.values.end(), 0.0);
  };
  const double usual = converted(bench);
  CHECK(usual > 0);
  bench.lamp_drift_per_min = -0.4;  // on average -20 % in a minute
  const double drifted = converted(bench);
  CHECK(drifted < 0.97 * usual);  // three times what it may differ by from a lamp of less light below
  bench.lamp_drift_per_min = 0;
  bench.printer.projector.max_intensity_mw_cm2 *= 0.8;
  CHECK(drifted == doctest::Approx(converted(bench)).epsilon(0.01));
  bench.printer.projector.max_intensity_mw_cm2 /= 0.8;
  bench.centre_px = 5;  // the vial to the right of the lit column
  SimPrint aside(bench);
  for (int n = 0; n < 240; ++n) aside.pass(&frame, 0, 1);
  const auto volume = aside.resin().conversion();
  double moment = 0;
  double sum = 0;
  for (std::size_t v = 0; v < volume.values.size(); ++v) {
    const double value = static_cast<double>(volume.values[v]);
    moment += value * volume.grid.x_mm(static_cast<double>(v % static_cast<std::size_t>(volume.grid.nx)));
    sum += value;
  }
  // Column 31 is 4.5 columns, 0.9 mm, to the left of the vial's axis, which 1.49 divides.
  CHECK(moment / sum == doctest::Approx(-0.9 / 1.49).epsilon(0.05));
}

TEST_CASE("The simulated bench cures by the flips of its log, each at the angle of the stage, and by no other light") {
  const std::string folder = std::filesystem::temp_directory_path() / ("vam-cure-" + std::to_string(getpid()));
  std::filesystem::create_directory(folder);
  SimBench bench = small_bench();
  GreyImage frame(bench.printer.projector.columns, bench.printer.projector.rows, 8);
  for (int r = 12; r < 20; ++r) {
    for (int c = 28; c < 36; ++c) frame(c, r) = 255;
  }
  SimSources sources{.angles = folder + "/angles", .shown = folder + "/shown", .images = {frame}};
  std::ofstream table(sources.angles);
  std::ofstream flips(sources.shown);
  table << R"({"t_monotonic_s":100.0,"event":"standing","angle_deg":40})"
        << "\n"
        << std::flush;
  flips << R"({"t_monotonic_s":101.0,"event":"flip","frame":0})"
        << "\n"
        << R"({"t_monotonic_s":131.0,"event":"flip","frame":-1})"
        << "\n"
        << std::flush;
  SimPrint followed(bench);
  SimWorld world(sources, 150, &followed);
  CHECK(followed.lit_s() == doctest::Approx(30));
  CHECK(world.moment(150).print == &followed);
  SimPrint direct(bench);
  direct.pass(&frame, 40, 30);
  direct.pass(nullptr, 40, 18.8);
  const auto one = followed.resin().conversion();
  const auto other = direct.resin().conversion();
  for (std::size_t v = 0; v < one.values.size(); ++v) {
    CHECK(std::abs(static_cast<double>(one.values[v]) - static_cast<double>(other.values[v])) < 0.01);
  }
  CHECK(*std::max_element(one.values.begin(), one.values.end()) > 0.5F);
  std::filesystem::remove_all(folder);
}

TEST_CASE("A simulated print needs a resin that absorbs and gels") {
  SimBench bench = small_bench();
  bench.printer.resin.absorption_per_mm = 0;
  CHECK(fault_of([&] { SimPrint print(bench); }) == Fault::usage);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// The fits on images of the simulated bench: what the simulator has set is what they find.
#include <utility>

#include "metrology/calibrate/beam.hpp"
#include "metrology/calibrate/cut_off.hpp"
#include "metrology/calibrate/vial_place.hpp"
#include "optics/patterns.hpp"
#include "sim/bench/scene.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

Image fractions(const GreyImage& levels) {
  Image image(levels.width, levels.height);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image.values[i] = static_cast<float>(levels.values[i]) / static_cast<float>(levels.full());
  }
  return image;
}

metrology::SweepScan swept(const sim::SimBench& bench, int pitch_px, int bits = 16, bool corrected = false) {
  const optics::PatternPlan line{"sweep", 1, pitch_px, 2 * pitch_px, 0};
  const auto& projector = bench.printer.projector;
  const sim::SimScene scene(bench, 1, bits);
  metrology::SweepScan scan;
  std::vector<std::vector<metrology::BandReading>> readings(3);
  scan.width_px = line.width_px;
  scan.height_mm = {2, 0, -2};
  scan.signal.resize(3);
  for (int n = 0; n < optics::pattern_frames(line, projector); ++n) {
    const GreyImage image = optics::pattern_frame(line, projector, n);
    const Image frame = fractions(scene.render({0, &image, 0}, 20000, n));
    scan.column.push_back(n * line.pitch_px + 0.5 * (line.width_px - 1));
    const auto bands = metrology::band_readings(frame, 3);
    for (std::size_t b = 0; b < 3; ++b) {
      readings[b].push_back(bands[b]);
      scan.signal[b].push_back(bands[b].mean());
    }
  }
  for (std::size_t b = 0; corrected && b < 3; ++b) scan.signal[b] = metrology::without_cut_off(readings[b]);
  return scan;
}

sim::SimBench small_bench() {
  sim::SimBench bench{.columns = 200, .rows = 60, .axis_column = 2.5, .tilt_deg = 0.4};
  auto& printer = bench.printer;
  printer.projector.columns = 256;
  printer.projector.rows = 64;
  printer.projector.pixel_mm = 0.1;
  printer.projector.axis_column = 127.5;
  printer.projector.axis_row = 31;
  printer.vial.radius_mm = 9;
  printer.camera.pixel_mm = 0.15;
  printer.bath = {1.53, 12};
  return bench;
}

// How far the fit of a sweep without noise is from what the bench was set to: what the simulator and the fit do alike
// to every scan. Columns, and parts of the radius.
std::pair<double, double> edges_off(sim::SimBench bench, int pitch_px) {
  bench.centre_px = 3.2;
  const auto found = metrology::find_edges(swept(bench, pitch_px), bench.printer);
  return {found.axis_column.value - bench.printer.projector.axis_column - bench.centre_px,
          found.radius_mm.value / bench.printer.vial.radius_mm - 1};
}

}  // namespace

// A hundredth and a tenth of what a scan may be off by.
TEST_CASE("Edges in a bath on the simulated bench: no bias, telecentric or through a window") {
  sim::SimBench bench = small_bench();
  for (const bool telecentric : {true, false}) {
    bench.printer.projector.telecentric = telecentric;
    const auto [centre_px, radius] = edges_off(bench, 2);
    CHECK(std::abs(centre_px) < 1e-3);
    CHECK(std::abs(radius) < 5e-5);
  }
}

// Of a dim sweep nearly all pixels are dark, and noise below level 0 is cut off: without correction the radius is
// several of its sigmas too small.
TEST_CASE("Edges in the dark of a camera that cuts noise off: corrected at several radii") {
  for (const double radius_mm : {7.0, 9.0, 11.0}) {
    CAPTURE(radius_mm);
    sim::SimBench bench = small_bench();
    bench.bodies.clear();
    bench.beam_mm = 0.5;
    bench.glow = 4;
    bench.noise = 0.004;
    bench.background = 0;
    bench.printer.projector.telecentric = true;
    bench.printer.vial.radius_mm = radius_mm;
    const auto plain = metrology::find_edges(swept(bench, 2, 8), bench.printer).radius_mm;
    const auto found = metrology::find_edges(swept(bench, 2, 8, true), bench.printer).radius_mm;
    CHECK(plain.value - radius_mm < -2 * plain.sigma);
    const double sigma = std::hypot(found.sigma, (found.value - plain.value) / 3);
    CHECK(std::abs(found.value - radius_mm) < 2 * sigma);
    CHECK(std::abs(found.value - radius_mm) < 0.5 * std::abs(plain.value - radius_mm));
  }
}

// Lines of 8 columns, 4 apart: only the middle of the vial is brighter than half the height of the signal, and the fit
// must begin far outside it. Now and then a line is lost with its frames.
TEST_CASE("Edges of a sweep in wide steps: wherever the vial stands, and without one of the lines") {
  for (const double centre_px : {0.8, 1.2, 4.9}) {
    for (const int lost : {0, 47, 49}) {
      CAPTURE(centre_px);
      CAPTURE(lost);
      sim::SimBench bench = small_bench();
      bench.bodies.clear();
      bench.glow = 5;
      bench.beam_mm = 0.5;
      bench.noise = 0.002;
      bench.centre_px = centre_px;
      bench.printer.projector.columns = 208;
      bench.printer.projector.axis_column = 103.5;
      bench.printer.projector.telecentric = true;
      metrology::SweepScan scan = swept(bench, 4, 8);
      scan.column.erase(scan.column.begin() + lost);
      for (auto& band : scan.signal) band.erase(band.begin() + lost);
      const auto found = metrology::find_edges(scan, bench.printer);
      CHECK(std::abs(found.axis_column.value - 103.5 - centre_px) < 0.1);
      CHECK(std::abs(found.radius_mm.value / 9 - 1) < 5e-4);
    }
  }
}

// A black level that shows the noise whole, and a bright scene, are left as they are.
TEST_CASE("Nothing is corrected where no noise is cut off") {
  sim::SimBench bench = small_bench();
  bench.noise = 0.002;
  bench.background = 0.02;
  CHECK(swept(bench, 8, 8, true).signal == swept(bench, 8, 8).signal);
}

// An edge is steeper the less light is left there; the simulator absorbs it, too.
TEST_CASE("Edges in a resin that absorbs: no bias at several radii") {
  for (const double radius_mm : {7.0, 9.0, 11.0}) {
    for (const double absorption_per_mm : {0.05, 0.15}) {
      CAPTURE(radius_mm);
      CAPTURE(absorption_per_mm);
      sim::SimBench bench = small_bench();
      bench.beam_mm = 0.5;
      bench.printer.projector.telecentric = true;
      bench.printer.vial.radius_mm = radius_mm;
      bench.printer.resin.absorption_per_mm = absorption_per_mm;
      CHECK(std::abs(edges_off(bench, 4).second) < 5e-5);
    }
  }
}

// Near grazing the light turns by up to 49 degrees, and the camera receives most of it where its lines of sight cross
// each other. What is left is the sweep's pitch of 4 pixels.
TEST_CASE("Edges in air on the simulated bench: no bias, telecentric or not") {
  sim::SimBench bench;  // the printer of [RAY21]
  bench.printer.camera.binning = 1;
  bench.printer.camera.pixel_mm = 0.156;
  bench.columns = 180;
  bench.rows = 60;
  for (const bool telecentric : {true, false}) {
    bench.printer.projector.telecentric = telecentric;
    const auto [centre_px, radius] = edges_off(bench, 4);
    CHECK(std::abs(centre_px) < 0.01);
    CHECK(std::abs(radius) < 5e-5);
  }
}

// A lit row is a box of a pixel's height, as wide as a Gaussian of 0.68 of it. What is left is that a plane
// is 1.6 mm thick, and that such a row is no Gaussian: a hundredth.
TEST_CASE("A lit row seen from the side: waist, focus and divergence of the simulated beam") {
  sim::SimBench bench = small_bench();
  bench.axis_column = 0;
  bench.beam_mm = 0.5;
  bench.focus_mm = 1.5;
  bench.divergence_deg = 3.5;
  bench.glow = 2;
  auto& printer = bench.printer;
  const GreyImage image = optics::pattern_frame({"row", 1, 1, 1, 0}, printer.projector, 0);
  for (const double azimuth : {90.0, -90.0}) {
    printer.camera.azimuth_deg = azimuth;
    const Image frame = fractions(sim::SimScene(bench, 1, 16).render({0, &image, 0}, 20000, 0));
    const auto widths = metrology::side_widths(frame, {0.15, 99.5}, printer, 9);
    const auto beam = metrology::measure_beam(widths);
    CHECK(beam.waist_mm.value == doctest::Approx(std::hypot(0.5, 0.068)).epsilon(0.01));
    CHECK(std::abs(beam.focus_mm.value - 1.5) < 0.1);
    CHECK(beam.divergence_deg.value == doctest::Approx(3.5).epsilon(0.02));
  }
  printer.camera.azimuth_deg = 60;
  CHECK(has(message_of([&] {
              (void)metrology::side_widths(Image(200, 60), {0.15, 99.5}, printer, 9);
            }),
            "at 60 degrees to the beam"));
  printer.camera.azimuth_deg = 90;
  CHECK(has(message_of([&] { (void)metrology::side_widths(Image(20, 60), {0.15, 9.5}, printer, 9); }), "at least 32"));
  CHECK(fault_of([&] { (void)metrology::side_widths(Image(200, 60), {0.15, 99.5}, printer, 9); }) == Fault::data);
}

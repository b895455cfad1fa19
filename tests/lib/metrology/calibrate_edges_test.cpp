// SPDX-License-Identifier: GPL-3.0-or-later
// trials: 200 -tc=Vial edges: many sweeps*
#include "lib/metrology/coverage.hpp"
#include "metrology/calibrate/cut_off.hpp"
#include "metrology/calibrate/private/edges.hpp"
#include "metrology/calibrate/vial_place.hpp"
#include "oracle/calibration_scans.hpp"
#include "testing.hpp"
#include "trials.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

model::Printer printer_of(const vam::oracle::SweepTruth& truth) {
  model::Printer printer;
  printer.projector.pixel_mm = truth.pixel_mm;
  printer.projector.telecentric = !truth.lens_mm;
  printer.projector.lens_distance_mm = truth.lens_mm;
  printer.camera.distance_mm = truth.camera_mm;
  printer.camera.azimuth_deg = truth.camera_rad * 180 / 3.14159265358979;
  printer.vial = {12.7, truth.wall_mm, truth.glass_index};  // the radius is to be found
  printer.resin.index = truth.resin_index;
  printer.resin.absorption_per_mm = truth.absorption_per_mm;
  return printer;
}

constexpr int bands = 3;
constexpr double band_mm = 6;

SweepScan swept(const vam::oracle::SweepTruth& truth, double pitch_px, double first, double last,
                vam::oracle::Random& random) {
  const vam::oracle::SweepBench bench(truth);
  const std::vector<double> height_mm{7.5, 6, 4.5, 1.5, 0, -1.5, -4.5, -6, -7.5};  // three rows a band
  SweepScan scan{.width_px = 2, .height_mm = {band_mm, 0, -band_mm}};
  scan.signal.resize(bands);
  for (double column = first; column <= last; column += pitch_px) {
    scan.column.push_back(column);
    const auto readings = band_readings(bench.frame(column, scan.width_px, height_mm, 32, random), bands);
    for (int b = 0; b < bands; ++b) scan.signal[b].push_back(readings[b].mean());
  }
  return scan;
}

}  // namespace

TEST_CASE("Vial edges: many sweeps, 95 % inside 2 sigma, centre within 0.1 px, radius within 0.05 %") {
  vam::oracle::Random random(7);
  std::uniform_real_distribution<double> part;
  test::Coverage centre("centre"), radius("radius"), tilt("tilt");
  for (int run = 0; run < trials_or(48); ++run) {
    vam::oracle::SweepTruth truth{.radius_mm = 10 + 4 * part(random)};
    if (run % 4 == 0) {  // a glass wall that is not matched
      truth.wall_mm = 1;
      truth.glass_index = 1.47;
    }
    if (run % 2 == 1) truth.lens_mm.reset();        // telecentric
    if (run % 4 == 2) truth.camera_rad *= 5.0 / 6;  // 75 degrees from the projector
    if (run % 8 > 5) truth.camera_rad *= -1;
    truth.axis_column = 490 + 40 * part(random);
    truth.tilt_rad = (part(random) - 0.5) * 0.03;
    truth.blur_px = 0.5 + 2 * part(random);
    truth.slope = (part(random) - 0.5);
    truth.absorption_per_mm = run % 3 * 0.05;
    const double reach = 1.25 * truth.radius_mm / truth.pixel_mm;
    const auto scan = swept(truth, 2, std::floor(truth.axis_column - reach), truth.axis_column + reach, random);
    const VialEdges found = find_edges(scan, printer_of(truth));
    centre.add(found.axis_column, truth.axis_column);
    radius.add(found.radius_mm, truth.radius_mm, 1 / truth.radius_mm);
    tilt.add(found.tilt_deg, truth.tilt_rad * 180 / 3.14159265358979);
  }
  centre.check();
  radius.check();
  tilt.check();
  CHECK(centre.worst() < 0.1);
  CHECK(radius.worst() < 5e-4);
}

// [physics §12]
TEST_CASE("Vial edges: the tangent column is further out than the vial") {
  vam::oracle::Random random(3);
  vam::oracle::SweepTruth truth{.noise = 0.5};
  const VialEdges found = find_edges(swept(truth, 1, 250, 770, random), printer_of(truth));
  const double tangent_px =
      truth.radius_mm / truth.pixel_mm / std::sqrt(1 - std::pow(truth.radius_mm / *truth.lens_mm, 2));
  CHECK(found.edge_px.value == doctest::Approx(tangent_px).epsilon(3e-4));
  CHECK(found.radius_mm.value == doctest::Approx(truth.radius_mm).epsilon(3e-4));
  CHECK(found.blur_px.value == doctest::Approx(truth.blur_px).epsilon(0.2));
}

TEST_CASE("Vial edges: each is sought at half of its own side's light") {
  std::vector<double> column, signal;
  for (int i = 0; i < 60; ++i) {
    column.push_back(2 * i);
    signal.push_back(i < 10 || i >= 50 ? 20 : 45 + 55 * std::exp((10 - i) / 6.0));  // 100 at one edge, 45 at the other
  }
  const SteepestEdges edges = steepest(column, signal);
  CHECK(edges.clear);
  CHECK(std::abs(edges.rise - 19) <= 2);
  CHECK(std::abs(edges.fall - 99) <= 2);
}

TEST_CASE("Vial edges: a sweep without an edge, a dark one, and an image without rows are errors") {
  vam::oracle::Random random(5);
  vam::oracle::SweepTruth truth;
  CHECK(fault_of([&] { (void)find_edges(swept(truth, 4, 500, 800, random), printer_of(truth)); }) == Fault::data);
  CHECK(fault_of([&] { (void)find_edges(swept(truth, 4, 800, 1000, random), printer_of(truth)); }) == Fault::data);
  CHECK(fault_of([&] { (void)find_edges(swept(truth, 100, 0, 1000, random), printer_of(truth)); }) == Fault::data);
  CHECK(fault_of([] { (void)band_readings(Image(4, 2), 3); }) == Fault::data);
}

TEST_CASE("Vial edges: a camera from 60 to 91 degrees beside the beam is accepted, to the last bit") {
  const auto problem = [](double azimuth_deg) {
    model::Printer printer = printer_of({});
    printer.camera.azimuth_deg = azimuth_deg;
    return error_of([&] { (void)find_edges({}, printer); }, Fault::data);
  };
  for (const double side : {-1.0, 1.0}) {
    for (const double azimuth_deg : {60.0, 90.0, 91.0})
      CHECK_FALSE(has(problem(side * azimuth_deg), "the camera is at"));
    for (const double azimuth_deg : {59.9, 91.1, 180.0}) CHECK(has(problem(side * azimuth_deg), "the camera is at"));
  }
}

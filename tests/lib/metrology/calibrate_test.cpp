// SPDX-License-Identifier: GPL-3.0-or-later
// Response, flat field, beam and camera axis: 200 scans of each, and what is refused.
#include "lib/metrology/coverage.hpp"
#include "metrology/calibrate/axis.hpp"
#include "metrology/calibrate/beam.hpp"
#include "metrology/calibrate/flat.hpp"
#include "metrology/calibrate/lag.hpp"
#include "metrology/calibrate/recorded_angle_fit.hpp"
#include "metrology/calibrate/response.hpp"
#include "metrology/calibrate/wobble.hpp"
#include "oracle/calibration_scans.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;
using namespace vam::stats;

namespace {

constexpr int runs = 200;
std::uniform_real_distribution<double> part;
std::normal_distribution<double> unit;

// A display's curve: power law over a leak.
double true_light(double grey, double gamma, double leak) { return leak + (1 - leak) * std::pow(grey / 255, gamma); }

ResponseScan ramp(double gamma, double leak, int readings, double noise, vam::oracle::Random& random) {
  ResponseScan scan;
  for (int level = 0; level <= 16; ++level) {
    scan.grey.push_back(level == 16 ? 255 : 16 * level);
    scan.light.emplace_back();
    for (int i = 0; i < readings; ++i) {
      const double light = true_light(scan.grey.back(), gamma, leak);
      scan.light.back().push_back(3000 * light * (1 + noise * unit(random)) + 2 * unit(random));
    }
  }
  return scan;
}

// Two turns of a bead in frames whose time stamps are late; its column by its own angle, the reported one by the stamp.
TurnScan late_turn(double speed_deg_s, int direction, double lag_s, double bead_deg, vam::oracle::Random& random,
                   std::vector<double>& time_s) {
  TurnScan turn{.rows = 60};
  turn.middle.resize(1);
  time_s.clear();
  for (int i = 0; i < 72; ++i) {
    const double taken_s = 10.0 * i / speed_deg_s;
    const double own_deg = direction * speed_deg_s * taken_s;
    turn.middle[0].push_back(102 + 40 * std::cos((own_deg - bead_deg) * std::numbers::pi / 180) + 0.05 * unit(random));
    turn.angle_deg.push_back(speed_deg_s * (taken_s + lag_s));
    time_s.push_back(100 + taken_s + lag_s);
  }
  return turn;
}

// A stage of 60 deg/s whose speed ripples by 3 % each 30 degrees, and is 0.3 % higher in the end than at the start.
double rippled_deg(double t_s) {
  const double line_deg = 60 * t_s * (1 + 0.003 * t_s / 12);
  return line_deg + 0.14 * std::cos(12 * line_deg * std::numbers::pi / 180);
}

// Its answers, each up to 20 ms on its way there and up to 20 ms back.
std::vector<StagePoint> late_points(vam::oracle::Random& random) {
  std::vector<StagePoint> points;
  for (double t_s = -0.1; t_s < 12.1;) {
    const double there_s = 0.02 * part(random), back_s = 0.02 * part(random);
    points.push_back(
        {t_s + 0.5 * (there_s + back_s), rippled_deg(t_s + there_s), 60 * (there_s + back_s) / std::sqrt(12.0)});
    t_s += std::max(0.01, there_s + back_s);
  }
  return points;
}

}  // namespace

TEST_CASE("Response: 200 ramps, 95 % of all levels inside 2 sigma, never falling") {
  vam::oracle::Random random(11);
  test::Coverage levels("levels");
  for (int run = 0; run < runs; ++run) {
    const double gamma = 1 + 1.4 * part(random);
    const double leak = 0.002 * part(random);
    const auto curve = measure_response(ramp(gamma, leak, 5, 0.004, random));
    for (std::size_t i = 0; i + 1 < curve.grey.size(); ++i) {
      levels.add(curve.intensity[i], true_light(curve.grey[i], gamma, leak));
      CHECK(curve.intensity[i].value <= curve.intensity[i + 1].value);
    }
    CHECK(curve.intensity.back().value == 1);
    CHECK(curve.intensity.size() == 17);
  }
  levels.check();
  CHECK(levels.worst() < 0.02);
}

TEST_CASE("Response: few levels, single readings, darkness, falling intensity and saturation are errors") {
  vam::oracle::Random random(12);
  const auto refused = [](const ResponseScan& scan) { return message_of([&] { (void)measure_response(scan); }); };
  auto few = ramp(1, 0, 5, 0.01, random);
  few.grey.resize(9);
  few.light.resize(9);
  CHECK(has(refused(few), "9 grey levels"));
  CHECK(has(refused(ramp(1, 0, 2, 0.01, random)), "2 readings"));
  auto dark = ramp(1, 0, 5, 0.01, random);
  for (auto& readings : dark.light) readings = {1, -1, 0.5, -0.5, 0};
  CHECK(has(refused(dark), "no light"));
  auto drift = ramp(1, 0, 5, 0.001, random);
  for (double& reading : drift.light[10]) reading *= 1.3;
  CHECK(has(refused(drift), "falls by"));
  auto clipped = ramp(2.2, 0, 5, 0.004, random);
  for (auto& readings : clipped.light) {
    for (double& reading : readings) reading = std::min(reading, 1500.0);  // half of full
  }
  CHECK(has(refused(clipped), "have the same reading"));
  auto unsorted = ramp(1, 0, 5, 0.01, random);
  std::swap(unsorted.grey[3], unsorted.grey[4]);
  CHECK(has(refused(unsorted), "must rise"));
}

TEST_CASE("Flat field: the illumination profile is recovered, dead pixels are interpolated") {
  vam::oracle::Random random(13);
  const auto truth = [](int x, int y) { return 1 + 0.2 * std::sin(0.2 * x) * std::cos(0.1 * y); };
  FrameMean frames;
  for (int n = 0; n < 20; ++n) {
    Image frame(48, 32);
    for (const auto [y, x] : indices(frame.height, frame.width)) {
      frame(x, y) = static_cast<float>(100 + (x == 20 && y == 9 ? 0 : 800 * truth(x, y)) + 8 * unit(random));
    }
    frames.add(frame);
  }
  const Image dark(48, 32, 100);
  const FlatField flat = flat_field(frames, dark);
  CHECK(flat.dead == 1);
  CHECK(frames.noise() == doctest::Approx(8).epsilon(0.03));
  CHECK(flat.pixel_sigma == doctest::Approx(8 / std::sqrt(20) / flat.level.value).epsilon(0.05));
  CHECK(flat.unevenness == doctest::Approx(0.19).epsilon(0.1));
  double mean = 0;
  for (const auto [y, x] : indices(32, 48)) mean += truth(x, y) / 48 / 32;
  int inside = 0;
  for (const auto [y, x] : indices(32, 48)) {
    if (x == 20 && y == 9) {
      CHECK(flat.field(x, y) == doctest::Approx(truth(x, y) / mean).epsilon(0.02));
      continue;
    }
    if (std::abs(flat.field(x, y) - truth(x, y) / mean) < 2 * flat.pixel_sigma + 0.001) ++inside;
  }
  CHECK(inside >= 0.95 * 48 * 32);
  CHECK(fault_of([&] { frames.add(Image(4, 4)); }) == Fault::data);
  CHECK(fault_of([&] { (void)flat_field(frames, Image(4, 4)); }) == Fault::data);
  CHECK(fault_of([] { (void)flat_field(FrameMean(), {}); }) == Fault::data);
  FrameMean nothing;
  for (int n = 0; n < 3; ++n) nothing.add(Image(8, 8));
  CHECK(fault_of([&] { (void)flat_field(nothing, {}); }) == Fault::data);
}

TEST_CASE("Beam: width of each plane and divergence, 200 scans") {
  vam::oracle::Random random(17);
  test::Coverage width("width"), divergence("divergence"), at_axis("width at the axis");
  constexpr double pixel_mm = 0.0035;
  for (int run = 0; run < runs; ++run) {
    const double slope = 0.008 + 0.01 * part(random);
    const double waist_mm = 0.05 + 0.03 * part(random);
    const double focus_mm = 4 * (part(random) - 0.5);
    const auto fwhm_mm = [&](double y_mm) { return std::hypot(waist_mm, slope * (y_mm - focus_mm)); };
    BeamWidths widths;
    for (int plane = -5; plane <= 5; ++plane) {
      const double y_mm = 1.27 * plane;
      vam::oracle::BandTruth truth{.columns = 160,
                                   .rows = 48,
                                   .middle = 79.5 + 5 * (part(random) - 0.5),
                                   .half_width = 0.5 * fwhm_mm(y_mm) / pixel_mm,
                                   .blur_px = 1.5,
                                   .light = 400};
      const Measured px = line_width_px(vam::oracle::bright_band(truth, random), "plane");
      if (plane == 3) width.add(px, 2 * truth.half_width);
      widths.plane_mm.push_back(y_mm);
      widths.fwhm_mm.push_back({px.value * pixel_mm, px.sigma * pixel_mm, px.n});
    }
    const MeasuredBeam beam = measure_beam(widths);
    divergence.add(beam.divergence_deg, std::atan(slope) * 180 / std::numbers::pi);
    at_axis.add(beam.axis_fwhm_mm, fwhm_mm(0));
  }
  width.check();
  divergence.check();
  at_axis.check();
  CHECK(fault_of([] { (void)line_width_px(Image(50, 8), "plane"); }) == Fault::data);
  CHECK(fault_of([] { (void)line_width_px(Image(50, 50), "plane"); }) == Fault::data);
  CHECK(fault_of([] { (void)measure_beam({{0, 1, 2}, {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}); }) == Fault::data);
}

TEST_CASE("Camera axis: offset, tilt, wobble and its phase, 200 turns") {
  vam::oracle::Random random(19);
  test::Coverage column("column"), tilt("tilt"), wobble("wobble"), phase("phase");
  for (int run = 0; run < runs; ++run) {
    const double axis = 60 + 10 * part(random);
    const double lean = 0.04 * (part(random) - 0.5);
    const double amplitude = 1 + 2 * part(random);
    const double phase_deg = 30 + 300 * part(random);
    TurnScan scan{.rows = 24};
    scan.middle.resize(3);
    for (int n = 0; n < 24; ++n) {
      scan.angle_deg.push_back(15 * n + 3 * part(random));
      const double theta = (scan.angle_deg.back() - phase_deg) * std::numbers::pi / 180;
      vam::oracle::BandTruth truth{.columns = 130,
                                   .rows = 24,
                                   .middle = axis + amplitude * std::cos(theta) + 0.05 * std::sin(2 * theta),
                                   .lean = lean,
                                   .half_width = 30,
                                   .noise = 6};
      const auto middles = bright_middles(vam::oracle::bright_band(truth, random), 3);
      for (std::size_t b = 0; b < 3; ++b) scan.middle[b].push_back(middles[b]);
    }
    const CameraAxis found = find_camera_axis(scan);
    column.add(found.column, axis);
    tilt.add(found.tilt_deg, std::atan(lean) * 180 / std::numbers::pi);
    wobble.add(found.wobble_px, amplitude);
    phase.add(found.phase_deg, phase_deg);
    CHECK(found.bands == 3);
  }
  column.check();
  tilt.check();
  wobble.check();
  phase.check();
  CHECK(column.worst() < 0.1);
  TurnScan half{.rows = 3};
  half.middle.resize(1);
  for (int n = 0; n < 18; ++n) {
    half.angle_deg.push_back(10.0 * n);
    half.middle[0].push_back(7);
  }
  CHECK(has(message_of([&] { (void)find_camera_axis(half); }), "gap of 190"));
  for (double& angle : half.angle_deg) angle *= 2;
  half.middle[0].assign(18, NAN);
  CHECK(fault_of([&] { (void)find_camera_axis(half); }) == Fault::data);
}

TEST_CASE("wobble: axis and runout separated from four stage angles") {
  vam::oracle::Random random(23);
  test::Coverage axis("axis"), radius("radius"), phase("phase");
  for (int run = 0; run < runs; ++run) {
    const double at = 500 + 20 * part(random);
    const double out = 0.5 + 5 * part(random);
    const double towards_deg = 360 * part(random);
    std::vector<double> angle_deg;
    std::vector<Measured> middle;
    for (int i = 0; i < 4; ++i) {
      angle_deg.push_back(90 * i);
      const double sigma = 0.01 + 0.02 * part(random);
      const double theta = (90 * i - towards_deg) * std::numbers::pi / 180;
      middle.push_back({at + out * std::cos(theta) + sigma * unit(random), sigma, 50});
    }
    const Wobble found = find_wobble(angle_deg, middle, "test");
    axis.add(found.mean, at);
    radius.add(found.radius, out);
    phase.add({std::remainder(found.phase_deg.value - towards_deg, 360), found.phase_deg.sigma, 4}, 0);
  }
  axis.check();
  radius.check();
  phase.check();
  const auto at = [](std::vector<double> angles) {
    return [angles] { (void)find_wobble(angles, std::vector<Measured>(angles.size(), {1, 0.1, 9}), "edges"); };
  };
  CHECK(error_of(at({0, 90}), Fault::data).find("edges: 2 stage angles leave a gap of 270 degrees") == 0);
  CHECK(fault_of(at({0, 90, 180})) == Fault::data);
  at({0, 120, 240})();
}

TEST_CASE("Lag: the camera's delay, whatever it is, within 0.5 ms, 200 scans") {
  vam::oracle::Random random(29);
  test::Coverage lag("lag");
  for (int run = 0; run < runs; ++run) {
    const double true_ms = -20 + 80 * part(random);
    const double bead_deg = 360 * part(random);
    std::vector<double> time_s;
    const TurnScan one = late_turn(60, 1, 1e-3 * true_ms, bead_deg, random, time_s);
    const double speed = turning_speed_deg_s(time_s, one.angle_deg);
    CHECK(speed == doctest::Approx(60));
    const TurnScan two = late_turn(60, -1, 1e-3 * true_ms, bead_deg, random, time_s);
    lag.add(camera_lag_ms(find_camera_axis(one), speed, find_camera_axis(two), 60), true_ms);
  }
  lag.check();
  CHECK(lag.worst() < 0.5);
  std::vector<double> time_s;
  const CameraAxis axis = find_camera_axis(late_turn(60, 1, 0, 0, random, time_s));
  CHECK(has(error_of([&] { (void)camera_lag_ms(axis, 60, axis, -60); }, Fault::data), "rotates at -60 deg/s"));
  CHECK(fault_of([&] { (void)turning_speed_deg_s({0, 0}, {1, 2}); }) == Fault::data);
}

TEST_CASE(
    "The course of a stage that answers up to 20 ms late: its angles within 0.5 ms of turning, by its own sigma") {
  vam::oracle::Random random(31);
  test::Coverage phase("lag by a late stage, ms");
  std::vector<double> time_s;
  for (int i = 0; i < 72; ++i) time_s.push_back(0.02 + 12.0 / 72 * i);
  for (int run = 0; run < 100; ++run) {
    double off_deg = 0, variance = 0;
    for (int turn = 0; turn < 2; ++turn) {  // one either way
      const StageCourse course(late_points(random));
      std::vector<double> angle_deg;
      for (const double t_s : time_s) angle_deg.push_back(course.angle_deg(t_s));
      const auto weight = phase_weights(angle_deg, 360 * part(random));
      for (std::size_t i = 0; i < time_s.size(); ++i) {
        off_deg += 0.5 * weight[i] * (angle_deg[i] - rippled_deg(time_s[i]));
      }
      variance += 0.25 * std::pow(course.sigma_deg(time_s, weight), 2);
    }
    phase.add({1e3 / 60 * off_deg, 1e3 / 60 * std::sqrt(variance), 144}, 0);
  }
  phase.check();
  CHECK(phase.worst() < 0.5);
  CHECK(fault_of([] { StageCourse({{0, 0, 0.1}, {1, 60, 0.1}}); }) == Fault::data);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/stage/spin.hpp"

#include "base/text/json.hpp"
#include "device/stage/angle_fit.hpp"
#include "lib/device/virtual_stage.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;
using namespace vam::sim;

namespace {

// The stage's angle at a time, by the simulator's own log.
double true_angle_deg(const std::vector<Json>& log, double t_s) {
  const Json* before = nullptr;
  for (const auto& line : log) {
    if (line["event"] != "angle") continue;
    const double at_s = line["t_monotonic_s"];
    if (at_s > t_s && before != nullptr) {
      const double from_s = (*before)["t_monotonic_s"];
      const double part = (t_s - from_s) / (at_s - from_s);
      return (1 - part) * (*before)["angle_deg"].get<double>() + part * line["angle_deg"].get<double>();
    }
    before = &line;
  }
  return NAN;
}

}  // namespace

TEST_CASE("A run: ramp, a whole run-up turn at speed, the turns, a stop; zero is the stage's own") {
  for (const int direction : {1, -1}) {
    CAPTURE(direction);
    VirtualStage lab;
    home(*lab.stage, lab.clock, 60);
    move(*lab.stage, lab.clock, 123, false, 50, 60);
    SpinPlan plan{.speed_deg_s = 36, .turns = 2, .direction = direction};
    std::vector<AngleSample> samples;
    spin(*lab.stage, lab.clock, plan, [&](const AngleSample& sample) { samples.push_back(sample); });
    CHECK_FALSE(lab.truly_moves());
    REQUIRE(samples.size() > 100);
    // It began where the stage stood: 123 deg, or -123 seen the other way, and whole turns before zero.
    CHECK(std::abs(std::remainder(samples.front().angle_deg - direction * 123, 360.0)) < 0.1);
    CHECK(samples.front().angle_deg < -360);
    CHECK(samples.back().angle_deg >= 720);
    CHECK(samples.back().angle_deg < 721);
    for (const auto& sample : samples) {
      const double truth = direction * true_angle_deg(lab.log, sample.t_s);
      if (std::isfinite(truth) && sample.angle_deg > -360) {
        CHECK(std::abs(truth - sample.angle_deg) < 6 * sample.sigma_deg);
      }
    }
    AngleFit last_run_up(2);
    for (const auto& sample : samples) {
      if (sample.angle_deg > -360 && sample.angle_deg < -288) last_run_up.add(sample);
    }
    CHECK(last_run_up.speed_deg_s() == doctest::Approx(36).epsilon(1e-3));
  }
}

// [devices guarantee 2]
TEST_CASE("A moving stage is sampled every 200 ms at least, whatever the rate of the output") {
  VirtualStage lab;
  home(*lab.stage, lab.clock, 60);
  SpinPlan plan{.speed_deg_s = 60, .period_s = 1};
  std::vector<AngleSample> samples;
  spin(*lab.stage, lab.clock, plan, [&](const AngleSample& sample) { samples.push_back(sample); });
  CHECK_FALSE(lab.truly_moves());
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    CHECK(samples[i].t_s - samples[i - 1].t_s == doctest::Approx(1).epsilon(0.01));
  }
  CHECK(samples.back().angle_deg >= 360);
  CHECK(samples.back().angle_deg < 360 + 0.2 * 60);
  double asked_s = 0;
  bool moves = false;
  for (const auto& line : lab.log) {
    const double now_s = line["t_monotonic_s"];
    if (line["event"] == "moving") moves = true;
    if (line["event"] == "standing") moves = false;
    if (line["event"] != "command") continue;
    if (moves) CHECK(now_s - asked_s < 0.2);
    asked_s = now_s;
  }
}

TEST_CASE("Angle zero is at the same place in every run") {
  VirtualStage lab;
  home(*lab.stage, lab.clock, 60);
  SpinPlan plan{.speed_deg_s = 60, .period_s = 0.02};
  double turned_deg = 0;  // since homing, from the first angle of each run to the next
  for (int run = 0; run < 3; ++run) {
    double first_deg = NAN;
    spin(*lab.stage, lab.clock, plan, [&](const AngleSample& sample) {
      if (!std::isfinite(first_deg)) first_deg = sample.angle_deg;
    });
    CHECK(std::abs(std::remainder(turned_deg - first_deg, 360.0)) < 0.1);
    turned_deg += lab.stage->sample().angle_deg - first_deg;
  }
}

TEST_CASE("More turns than the travel allows are refused before anything moves") {
  VirtualStage lab(SimGcsSettings{.min_deg = -1000, .max_deg = 1000});
  home(*lab.stage, lab.clock, 60);
  SpinPlan plan{.turns = 3};
  CHECK(fault_of([&] { spin(*lab.stage, lab.clock, plan, [](const AngleSample&) {}); }) == Fault::data);
  CHECK(lab.commands("MOV") == 0);
}

TEST_CASE("GCS: a stage without reference does not spin, and is not made one that has it") {
  VirtualStage lab;
  SpinPlan plan{.speed_deg_s = 60};
  const auto print = [&] { spin(*lab.stage, lab.clock, plan, [](const AngleSample&) {}); };
  for (int attempt = 0; attempt < 2; ++attempt) {
    CHECK(has(error_of(print, Fault::data), "not referenced: the position of its zero is unknown; give --home"));
    CHECK(fault_of([&] { (void)plan_spin(*lab.stage, plan, false); }) == Fault::data);
  }
  CHECK(fault_of([&] { move(*lab.stage, lab.clock, 10, false, 30, 60); }) == Fault::data);
  CHECK(lab.commands("POS 1") == 0);
  CHECK(lab.commands("MOV") == 0);
  CHECK(lab.stage->sample().angle_deg == 0);  // at 17 deg in truth, which it cannot know
  (void)plan_spin(*lab.stage, plan, true);
  home(*lab.stage, lab.clock, 60);
  print();
  print();  // its zero was set meanwhile
}

TEST_CASE("A stage that is still braking is waited for") {
  SpinPlan plan{.speed_deg_s = 60};
  const std::vector<std::function<void(VirtualStage&)>> commands{
      [&](VirtualStage& lab) { spin(*lab.stage, lab.clock, plan, [](const AngleSample&) {}); },
      [](VirtualStage& lab) { home(*lab.stage, lab.clock, 60); },
      [](VirtualStage& lab) { move(*lab.stage, lab.clock, 20, false, 60, 60); }};
  for (const auto& command : commands) {
    VirtualStage lab;
    home(*lab.stage, lab.clock, 60);
    lab.stage->set_speed(60);
    lab.stage->start_move(3000);
    lab.clock.sleep_until(lab.clock.now_s() + 2);
    lab.stage->stop(Stop::smooth);  // which takes 0.3 s; a user before has ended so
    CHECK(lab.stage->moving());
    command(lab);
    CHECK_FALSE(lab.truly_moves());
  }
  VirtualStage lab;  // one that turns on and on is reported
  home(*lab.stage, lab.clock, 60);
  lab.stage->set_speed(60);
  lab.stage->start_move(3000);
  CHECK(fault_of([&] { spin(*lab.stage, lab.clock, plan, [](const AngleSample&) {}); }) == Fault::busy);
}

TEST_CASE("A stage 1 % off its speed may print, one 3 % off may not") {
  for (const double error : {-0.03, -0.01, 0.01, 0.03}) {
    CAPTURE(error);
    SimGcsSettings sim;
    sim.motor.speed_error = error;
    sim.jitter_s = 0.005;
    VirtualStage lab(sim);
    home(*lab.stage, lab.clock, 60);
    SpinPlan plan{.speed_deg_s = 25};
    double last_deg = -1e9;
    const auto fault = fault_of(
        [&] { spin(*lab.stage, lab.clock, plan, [&](const AngleSample& sample) { last_deg = sample.angle_deg; }); });
    CHECK_FALSE(lab.truly_moves());
    if (std::abs(error) < 0.02) {
      CHECK_FALSE(fault.has_value());
    } else {
      CHECK(fault == Fault::protocol);
      CHECK(last_deg < -0.5 * 25);  // half a second before light: a projector that follows has time to learn it
    }
  }
}

TEST_CASE("A blocked stage is detected within a few degrees") {
  SimGcsSettings sim;
  sim.faults.push_back({"block", "POS?", 900});
  VirtualStage lab(sim);
  home(*lab.stage, lab.clock, 60);
  SpinPlan plan{.speed_deg_s = 60, .turns = 5};
  CHECK(fault_of([&] { spin(*lab.stage, lab.clock, plan, [](const AngleSample&) {}); }) == Fault::protocol);
  double blocked_s = 0;
  for (const auto& line : lab.log) {
    if (line["event"] == "fault") blocked_s = line["t_monotonic_s"].get<double>();
  }
  REQUIRE(blocked_s > 0);
  // It coasts to a stop in 0.3 s (200 deg/s2) and is 2 deg behind its line long before.
  CHECK(lab.clock.now_s() - blocked_s < 0.3);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "base/text/json.hpp"
#include "device/stage/spin.hpp"
#include "device/stage/stage_backends.hpp"
#include "lib/device/virtual_stage.hpp"
#include "sim/controllers/controllers.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;
using namespace vam::sim;

namespace {

constexpr double microstep_deg = 360.0 / 384000;

struct ZaberLab : StageLab {
  explicit ZaberLab(const SimGcsSettings& sim = {}) : StageLab(make_sim_zaber, sim) {}
  void open(const ZaberSettings& settings = {}) { stage = make_zaber_stage(port(), clock, settings, nullptr); }
};

SpinPlan one_turn() { return {.speed_deg_s = 60, .run_up_turns = 0.5, .period_s = 0.05}; }

}  // namespace

TEST_CASE("A Zaber stage homes, moves and prints like any other stage") {
  for (const bool old : {false, true}) {
    CAPTURE(old);
    ZaberLab lab(SimGcsSettings{.old_firmware = old});
    lab.open();
    const Json about = describe(*lab.stage);
    CHECK(about["model"] == "device 50081");
    CHECK(about["simulated"] == true);
    CHECK(about["firmware"] == (old ? "6.28" : "7.33"));
    CHECK(about["max_deg"].get<double>() == doctest::Approx(36000));
    // accel is a whole number: 60 deg/s2 are 10.49 of its units, of which the device keeps 10.
    CHECK(about["acceleration_deg_s2"].get<double>() == doctest::Approx(60).epsilon(0.05));
    home(*lab.stage, lab.clock, 60);
    CHECK(lab.stage->sample().angle_deg == 0);
    move(*lab.stage, lab.clock, 30, false, 30, 60);
    CHECK(std::abs(lab.stage->sample().angle_deg - 30) < microstep_deg);
    std::vector<AngleSample> samples;
    spin(*lab.stage, lab.clock, one_turn(), [&](const AngleSample& sample) { samples.push_back(sample); });
    CHECK_FALSE(lab.truly_moves());
    CHECK(std::abs(std::remainder(samples.front().angle_deg - 30, 360.0)) < 0.1);
    CHECK(samples.back().angle_deg >= 360);
    CHECK((lab.commands("/1 1") > 0));
    CHECK(lab.commands("set pos") == 0);  // its memory is left alone
  }
}

TEST_CASE("Zaber: the speed goes with the motion, into the memory only of old firmware and only when it changes") {
  for (const bool old : {false, true}) {
    CAPTURE(old);
    ZaberLab lab(SimGcsSettings{.old_firmware = old});
    lab.open();
    home(*lab.stage, lab.clock, 60);
    for (const double to_deg : {10.0, 20.0}) move(*lab.stage, lab.clock, to_deg, false, 25, 60);
    int written = 0;
    double speed_deg_s = 0;
    for (const auto& line : lab.log) {
      if (line["event"] == "command" && line["text"].get<std::string>().find("set ") != std::string::npos) ++written;
      if (line["event"] == "moving") speed_deg_s = line["speed_deg_s"];
    }
    CHECK(written == (old ? 1 : 0));
    CHECK(speed_deg_s == doctest::Approx(25).epsilon(1e-4));  // 1.6384 units a microstep per second, rounded
  }
}

TEST_CASE("Zaber: refuses motion to an angle before homing, and takes one by an angle") {
  ZaberLab lab;
  lab.open();
  CHECK(has(error_of([&] { spin(*lab.stage, lab.clock, one_turn(), [](const AngleSample&) {}); }, Fault::data),
            "not referenced"));
  CHECK(fault_of([&] { move(*lab.stage, lab.clock, 10, false, 30, 60); }) == Fault::data);
  CHECK_FALSE(lab.truly_moves());
  move(*lab.stage, lab.clock, 10, true, 30, 60);
  CHECK(std::abs(lab.stage->sample().angle_deg - 10) < microstep_deg);
}

TEST_CASE("Zaber: only the addressed device obeys, and its axis") {
  ZaberLab lab(SimGcsSettings{.address = 2});
  CHECK(fault_of([&] { lab.open(); }) == Fault::busy);
  ZaberSettings second{.address = 2};
  lab.open(second);
  home(*lab.stage, lab.clock, 60);
  second.axis = 2;
  CHECK(has(error_of([&] { lab.open(second); }, Fault::protocol), "BADAXIS"));
}

TEST_CASE("A device other than a Zaber is refused") {
  VirtualClock clock;
  CHECK(fault_of([&] {
          (void)make_zaber_stage(make_sim_port(make_sim_gcs({}, clock.now_s(), {}), clock), clock, {}, nullptr);
        }) == Fault::busy);
}

TEST_CASE("Zaber: a stalled stage is reported by name") {
  SimGcsSettings sim;
  sim.faults.push_back({"stall", "", 3});
  ZaberLab lab(sim);
  lab.open();
  CHECK(has(error_of([&] { home(*lab.stage, lab.clock, 60); }, Fault::protocol), "FS (stalled and stopped)"));
  CHECK_FALSE(lab.stage->fault());
}

TEST_CASE("Zaber: corrupt replies are detected in time and the stage stops") {
  struct Case {
    const char* kind;
    Fault fault;
  };
  const std::vector<Case> cases{
      {"garbage", Fault::protocol},      {"truncated", Fault::busy},   {"late", Fault::busy},
      {"silent", Fault::busy},           {"error", Fault::protocol},   {"unplug", Fault::absent},
      {"wrong-sender", Fault::protocol}, {"power-loss", Fault::absent}};
  for (const std::string command : {"get version", "get pos", "get limit.max", "home", "warnings", "move abs", ""}) {
    for (const auto& [kind, fault] : cases) {
      for (const int occurrence : {1, 2}) {
        if (occurrence == 2 && (command == "get version" || command == "home" || command == "move abs")) continue;
        CAPTURE(command);
        CAPTURE(kind);
        CAPTURE(occurrence);
        // The question whether it moves is answered even by a refusal.
        if (command.empty() && kind == std::string("error")) continue;
        SimGcsSettings sim;
        sim.motor.acceleration_deg_s2 = 600;
        sim.faults.push_back({kind, command, occurrence});
        ZaberLab lab(sim);
        CHECK(fault_of([&] {
                lab.open();
                home(*lab.stage, lab.clock, 60);
                spin(*lab.stage, lab.clock, one_turn(), [](const AngleSample&) {});
              }) == fault);
        const double noticed_s = lab.clock.now_s();
        double due_s = 0;
        for (const auto& line : lab.log) {
          if (line["event"] == "fault") due_s = line["t_monotonic_s"].get<double>();
        }
        REQUIRE(due_s > 0);
        CHECK(noticed_s - due_s < 0.7);
        lab.stage.reset();
        lab.clock.sleep_until(lab.clock.now_s() + 0.5);
        if (std::string(kind) != "unplug") CHECK_FALSE(lab.truly_moves());
      }
    }
  }
}

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

struct GrblLab : StageLab {
  explicit GrblLab(const SimGcsSettings& sim = {}) : StageLab(make_sim_grbl, sim) {}
  void open(bool home_here = false) { stage = make_grbl_stage(port(), clock, 0, nullptr, home_here); }
};

// A reset in motion.
void alarm(GrblLab& lab) {
  lab.stage->set_speed(10);
  lab.stage->start_move(100);
  lab.clock.sleep_until(lab.clock.now_s() + 0.5);
  const auto other = lab.port();
  other->write("\x18");
  lab.clock.sleep_until(lab.clock.now_s() + 0.5);
  (void)other->read(0.1);  // its greeting
}

}  // namespace

TEST_CASE("GRBL: refuses motion before homing") {
  GrblLab lab(SimGcsSettings{.reset_at_open = true});
  lab.open();
  SpinPlan plan{.speed_deg_s = 60};
  const auto print = [&] { spin(*lab.stage, lab.clock, plan, [](const AngleSample&) {}); };
  CHECK(has(error_of(print, Fault::data), "not referenced: the position of its zero is unknown; give --home"));
  CHECK(fault_of([&] { move(*lab.stage, lab.clock, 10, false, 30, 60); }) == Fault::data);
  CHECK_FALSE(lab.truly_moves());
  move(*lab.stage, lab.clock, 10, true, 30, 60);  // by an angle it may turn
  home(*lab.stage, lab.clock, 60);
  print();
}

TEST_CASE("GRBL: a board that reports inches is refused, as its angles are none") {
  GrblLab lab(SimGcsSettings{.inches = true});
  lab.open();
  const auto told = error_of([&] { move(*lab.stage, lab.clock, 10, true, 30, 60); }, Fault::protocol);
  CHECK(has(told, "reports inches ($13=1), which are no degrees; send it $13=0"));
  CHECK_FALSE(lab.truly_moves());
}

TEST_CASE("GRBL: each process homes, with or without a start-up message; only homing unlocks the board") {
  for (const bool resets : {true, false}) {
    CAPTURE(resets);
    GrblLab lab(SimGcsSettings{.reset_at_open = resets});
    SpinPlan plan{.speed_deg_s = 60};
    const auto print = [&] { spin(*lab.stage, lab.clock, plan, [](const AngleSample&) {}); };
    for (int user = 0; user < 3; ++user) {
      lab.open();
      CHECK(fault_of(print) == Fault::data);
      CHECK(fault_of([&] { move(*lab.stage, lab.clock, 10, false, 30, 60); }) == Fault::data);
      CHECK(lab.stage->sample().angle_deg == 0);  // of a board that was not homed, wherever it stands
    }
    CHECK_FALSE(lab.truly_moves());
    home(*lab.stage, lab.clock, 60);
    print();
    lab.open();
    CHECK(fault_of(print) == Fault::data);
    CHECK(lab.commands("$X") == 0);
  }
}

TEST_CASE("GRBL: a board without switches takes its present position as zero, for one session") {
  GrblLab lab(SimGcsSettings{.no_switches = true});
  lab.open();
  CHECK(has(error_of([&] { home(*lab.stage, lab.clock, 60); }, Fault::protocol), "?home=here"));
  lab.open(true);
  SpinPlan plan{.speed_deg_s = 60};
  std::vector<AngleSample> samples;
  const auto print = [&] { spin(*lab.stage, lab.clock, plan, [&](const AngleSample& s) { samples.push_back(s); }); };
  CHECK(fault_of(print) == Fault::data);
  move(*lab.stage, lab.clock, 40, true, 30, 60);
  home(*lab.stage, lab.clock, 60);
  CHECK(lab.stage->sample().angle_deg == 0);
  CHECK(has(error_of([&] { move(*lab.stage, lab.clock, 10, false, 30, 60); }, Fault::data), "home=here"));
  print();
  CHECK(samples.back().angle_deg >= 360);
  lab.open(true);
  CHECK(fault_of(print) == Fault::data);
}

TEST_CASE("GRBL: home=here unlocks a board without switches, and is refused by one that has them") {
  GrblLab lab(SimGcsSettings{.no_switches = true});
  lab.open(true);
  alarm(lab);
  lab.open(true);
  home(*lab.stage, lab.clock, 60);
  CHECK(lab.commands("$X") == 1);
  move(*lab.stage, lab.clock, 10, true, 30, 60);
  GrblLab homes;
  homes.open(true);
  CHECK(has(error_of([&] { home(*homes.stage, homes.clock, 60); }, Fault::data), "omit home=here"));
}

TEST_CASE("GRBL: a locked board is not unlocked by a motion") {
  GrblLab lab;
  lab.open();
  alarm(lab);
  lab.open();
  CHECK(has(error_of([&] { move(*lab.stage, lab.clock, 10, true, 30, 60); }, Fault::protocol), "vam-stage home"));
  CHECK_FALSE(lab.truly_moves());
  home(*lab.stage, lab.clock, 60);
  move(*lab.stage, lab.clock, 10, true, 30, 60);
}

TEST_CASE("A GRBL board homes, moves and prints like any other stage") {
  GrblLab lab;
  lab.open();
  CHECK(describe(*lab.stage)["model"] == "Grbl 1.1h.20190830");
  CHECK(describe(*lab.stage)["serial"] == "stage 3 (simulated)");
  CHECK(describe(*lab.stage)["firmware"] == "1.1h.20190830");
  CHECK(lab.stage->caps().max_speed_deg_s == 90);
  home(*lab.stage, lab.clock, 60);
  CHECK(lab.stage->sample().angle_deg == 0);
  move(*lab.stage, lab.clock, 30, false, 30, 60);
  CHECK(lab.stage->sample().angle_deg == 30);
  SpinPlan plan{.speed_deg_s = 60};
  std::vector<AngleSample> samples;
  spin(*lab.stage, lab.clock, plan, [&](const AngleSample& sample) { samples.push_back(sample); });
  CHECK_FALSE(lab.truly_moves());
  CHECK(std::abs(std::remainder(samples.front().angle_deg - 30, 360.0)) < 0.1);
  CHECK(samples.back().angle_deg >= 360);
}

TEST_CASE("A device other than GRBL is refused") {
  VirtualClock clock;
  auto pi = make_sim_gcs({}, clock.now_s(), {});
  CHECK(fault_of([&] { (void)make_grbl_stage(make_sim_port(std::move(pi), clock), clock, 0, nullptr); }) ==
        Fault::busy);
}

TEST_CASE("GRBL: corrupt replies are detected in time and the stage stops") {
  struct Case {
    const char* kind;
    Fault fault;
  };
  const std::vector<Case> cases{{"garbage", Fault::protocol}, {"truncated", Fault::busy}, {"late", Fault::busy},
                                {"silent", Fault::busy},      {"error", Fault::protocol}, {"unplug", Fault::absent},
                                {"power-loss", Fault::absent}};
  SpinPlan plan{.speed_deg_s = 60, .run_up_turns = 0.5, .period_s = 0.05};
  for (const std::string command : {"$I", "$$", "$H", "$J", "?"}) {
    for (const auto& [kind, fault] : cases) {
      for (const int occurrence : {1, 3, 20}) {  // the second report is that of the search, which needs none
        if (command != "?" && occurrence > 1) continue;
        CAPTURE(command);
        CAPTURE(kind);
        // Half an "ok" is followed by a report on the same line.
        const bool half_of_home = command == "$H" && kind == std::string("truncated");
        SimGcsSettings sim;
        sim.motor.acceleration_deg_s2 = 600;
        sim.faults.push_back({kind, command, occurrence});
        GrblLab lab(sim);
        CHECK(fault_of([&] {
                lab.open();
                home(*lab.stage, lab.clock, 60);
                spin(*lab.stage, lab.clock, plan, [](const AngleSample&) {});
              }) == (half_of_home ? Fault::protocol : fault));
        const double noticed_s = lab.clock.now_s();
        double due_s = 0;  // "$H" is answered when the search is over
        for (const auto& line : lab.log) {
          const bool over = command == "$H" && line["event"] == "standing";
          if (line["event"] == "fault" || over) due_s = line["t_monotonic_s"].get<double>();
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

TEST_CASE("A GRBL board that searches its reference is stopped like one that jogs") {
  SimGcsSettings sim{.home_deg = 170};
  sim.motor.acceleration_deg_s2 = 600;
  GrblLab lab(sim);
  lab.open();
  CHECK(fault_of([&] { home(*lab.stage, lab.clock, 1); }) == Fault::busy);  // 170 deg at 30 deg/s take longer
  lab.clock.sleep_until(lab.clock.now_s() + 0.5);
  CHECK_FALSE(lab.truly_moves());
  home(*lab.stage, lab.clock, 60);
  CHECK(lab.stage->sample().angle_deg == 0);
}

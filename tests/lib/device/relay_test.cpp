// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/safety/relay.hpp"

#include <memory>
#include <utility>

#include "base/text/json.hpp"
#include "device/projector/relayed_lamp.hpp"
#include "lib/device/virtual_stage.hpp"
#include "sim/controllers/controllers.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;
using namespace vam::sim;

namespace {

struct RelayLab : StageLab {
  explicit RelayLab(const SimGcsSettings& sim = {}) : StageLab(make_sim_relay, sim), relay(port(), clock, nullptr) {}
  /// Beats at every flip of a 60 Hz screen.
  void show(double seconds) {
    for (const double end_s = clock.now_s() + seconds; clock.now_s() < end_s;) {
      clock.sleep_until(clock.now_s() + 1.0 / 60);
      relay.beat();
    }
  }
  std::string state() {
    device->advance(clock.now_s());
    std::string last = "open";
    for (const auto& line : log) {
      if (line["event"] == "closed") last = "closed";
      if (line["event"] == "open") last = "open: " + line["reason"].get<std::string>();
    }
    return last;
  }
  Relay relay;
};

// An engine that takes long to go dark.
struct SlowLamp final : Lamp {
  explicit SlowLamp(RelayLab& of) : lab(of) {}
  void on() override {}
  void dark() override {
    lab.clock.sleep_until(lab.clock.now_s() + 0.2);
    relay_was = lab.state();
  }
  RelayLab& lab;
  std::string relay_was;
};

// Says one line.
class Line final : public Port {
 public:
  explicit Line(std::string line) : line_(std::move(line)) {}
  void write(std::string_view) override {}
  std::string read(double) override { return std::exchange(line_, ""); }
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  std::string line_;
  std::string name_ = "port";
};

}  // namespace

TEST_CASE("A relay is closed while it hears a heartbeat, and no longer") {
  RelayLab lab;
  CHECK(lab.relay.identify()["limit_ms"] == 300);
  CHECK(lab.relay.identify().at("model") == "relay (simulated)");
  CHECK(lab.state() == "open");
  lab.relay.close();
  lab.show(5);
  CHECK(lab.state() == "closed");
  lab.relay.open();
  CHECK(lab.state() == "open: order");
  lab.relay.close();
  lab.show(0.5);
  const double last_s = lab.clock.now_s();
  lab.clock.sleep_until(last_s + 0.24);  // the last heartbeat may be 50 ms old
  CHECK(lab.state() == "closed");
  lab.clock.sleep_until(last_s + 0.31);
  CHECK(lab.state() == "open: heartbeat");
  // It stays open, and the print is told.
  CHECK(has(error_of([&] { lab.show(1); }, Fault::protocol), "has switched off the lamp"));
  CHECK(lab.state() == "open: heartbeat");
}

TEST_CASE("No light without an answer of the relay") {
  struct Case {
    const char* kind;
    const char* command;
    int occurrence;
    Fault fault;
  };
  const std::vector<Case> cases{{"garbage", "?", 1, Fault::protocol}, {"silent", "A", 1, Fault::busy},
                                {"error", "A", 1, Fault::busy},       {"late", "A", 1, Fault::busy},
                                {"unplug", "A", 1, Fault::absent},    {"garbage", "H", 9, Fault::protocol},
                                {"unplug", "H", 9, Fault::absent},    {"power-loss", "H", 9, Fault::absent}};
  for (const auto& [kind, command, occurrence, fault] : cases) {
    CAPTURE(kind);
    CAPTURE(command);
    SimGcsSettings sim;
    sim.faults.push_back({kind, command, occurrence});
    CHECK(fault_of([&] {
            RelayLab lab(sim);
            lab.relay.close();
            lab.show(2);
          }) == fault);
  }
  // One answer that is lost is none of its business: the next one comes before the time is over.
  SimGcsSettings sim;
  sim.faults.push_back({"silent", "H", 9});
  RelayLab lab(sim);
  lab.relay.close();
  lab.show(2);
  CHECK(lab.state() == "closed");
}

TEST_CASE("When a print fails the relay opens before the light engine replies, at its end after it") {
  for (const bool fails : {false, true}) {
    RelayLab lab;
    lab.relay.close();
    lab.show(0.1);
    SlowLamp engine(lab);
    RelayedLamp lamp(&engine, lab.relay);
    fails ? lamp.cut() : lamp.dark();
    CHECK(engine.relay_was == (fails ? "open: order" : "closed"));
    CHECK_NOTHROW(lab.relay.beat());  // none follows
    lab.relay.open();
    CHECK(lab.state() == "open: order");
  }
}

TEST_CASE("A relay states a time limit of 150 to 1000 ms") {
  VirtualClock clock;
  const auto limit_ms = [&](const std::string& line) {
    return Relay(std::make_unique<Line>(line), clock, nullptr).identify()["limit_ms"].get<double>();
  };
  CHECK(limit_ms("vam-relay 1 150\n") == doctest::Approx(150));
  CHECK(limit_ms("vam-relay 1 1000 made by hand\n") == doctest::Approx(1000));
  for (const char* line : {"vam-relay 1 149\n", "vam-relay 1 1001\n", "vam-relay 2 300\n", "vam-relay 1 x\n",
                           "relay 1 300\n", "vam-relay 1\n"}) {
    CAPTURE(line);
    CHECK(fault_of([&] { (void)limit_ms(line); }) == Fault::protocol);
  }
}

TEST_CASE("Another device is not taken for a relay") {
  VirtualClock clock;
  CHECK(fault_of([&] { Relay(make_sim_port(make_sim_gcs({}, clock.now_s(), {}), clock), clock, nullptr); }) ==
        Fault::busy);
}

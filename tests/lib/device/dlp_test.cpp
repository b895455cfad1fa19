#include <doctest/doctest.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "device/guardian_actions.hpp"
#include "device/light_engine.hpp"
#include "device/sim_dlp.hpp"
#include "fault_of.hpp"

using namespace vam;
using namespace vam::device;

namespace {

struct LightLab {
  explicit LightLab(const SimDlpSettings& sim = {}, const LightSettings& settings = {})
      : light(make_dlp_light(make_sim_dlp(sim, [this](const Json& line) { log.push_back(line); }), settings, nullptr)) {
  }
  // The LEDs that truly shine, by the engine's own log.
  [[nodiscard]] int shining() const { return log.empty() ? 8 : log.back()["bits"].get<int>(); }
  std::vector<Json> log;
  std::unique_ptr<LightEngine> light;
};

}  // namespace

TEST_CASE("The light engine wakes dark, shines when told, and is dark again") {
  LightLab lab;
  CHECK(lab.light->identify()["firmware"] == "4.0.1");
  lab.light->prepare();
  CHECK(lab.shining() == 0);
  lab.light->on();
  CHECK(lab.shining() == 4);
  lab.light->dark();
  CHECK(lab.shining() == 0);
  lab.light->on();
  lab.light->standby();
  CHECK(lab.shining() == 0);
}

namespace {

// A simulated engine that keeps what it was sent, as hex without the padding of the 64 bytes.
class Heard final : public UsbLink {
 public:
  Heard(std::unique_ptr<UsbLink> link, std::vector<std::string>& reports) : link_(std::move(link)), reports_(reports) {}
  void control_out(int, int, int) override { reports_.emplace_back("control"); }
  std::string control_in(int, int, int, int) override { return ""; }
  void write_report(const std::string& report) override {
    reports_.push_back(to_hex(report));
    link_->write_report(report);
  }
  std::string read_report() override { return link_->read_report(); }
  const std::string& name() const override { return link_->name(); }
  Json about() const override { return link_->about(); }

 private:
  std::unique_ptr<UsbLink> link_;
  std::vector<std::string>& reports_;
};

}  // namespace

// By hand from TI DLPU010 and DLPU018: flags (40 write, C0 read), sequence, length of what follows, CMD3, CMD2, data.
TEST_CASE(
    "Every byte to the engine: woken, dark, video, gamma off, current; on; LEDs off, then no pattern, then asleep") {
  for (const bool dlpc900 : {false, true}) {
    CAPTURE(dlpc900);
    std::vector<std::string> reports;
    {
      LightSettings settings;
      settings.current = 0x55;
      const auto light =
          make_dlp_light(std::make_unique<Heard>(make_sim_dlp({.dlpc900 = dlpc900}, {}), reports), settings, nullptr);
      light->prepare();
      light->on();
    }
    const std::vector<std::string> wanted{"40010300000200",     "c00202000002",  // power 0: awake
                                          "40030300071a00",     "c0040200071a",  // LED enable 0
                                          "400503001b1a00",     "c00602001b1a",  // video mode
                                          "c0070200001a",                        // input source: what it is,
                                          "40080300001a08",     "c0090200001a",  //   then its port bits 0
                                          "c00a02000e1a",                        // gamma: what it is,
                                          "400b03000e1a00",     "c00c02000e1a",  //   then off
                                          "400d0500010b555555", "c00e0200010b",  // LED current
                                          "c00f02000a1a",                        // hardware status
                                          "40100300071a04",     "c0110200071a",  // LED enable: blue
                                          "40120300071a00",     "c0130200071a",  // LED enable 0
                                          "40140300241a00",                      // pattern stop
                                          "40150300000201"};                     // power 1: asleep
    CHECK(reports == wanted);
  }
}

TEST_CASE("An engine that wakes slowly is waited for; one that refuses to stop a pattern still goes to sleep") {
  LightLab slow({.wake_reads = 2});
  slow.light->prepare();
  CHECK(slow.shining() == 0);
  std::vector<std::string> reports;
  const auto light =
      make_dlp_light(std::make_unique<Heard>(make_sim_dlp({.refuse = 0x1A24}, {}), reports), {}, nullptr);
  light->prepare();
  light->standby();
  CHECK(reports.back().substr(4) == "0300000201");
}

TEST_CASE("Leaving without a word is dark, too") {
  std::vector<Json> log;
  {
    const auto light = make_dlp_light(make_sim_dlp({}, [&](const Json& line) { log.push_back(line); }), {}, nullptr);
    light->prepare();
    light->on();
    CHECK(log.back()["bits"] == 4);
  }
  CHECK(log.back()["bits"] == 0);
}

TEST_CASE("The current is capped, as given and as found") {
  LightSettings settings;
  settings.current = 120;
  CHECK(fault_of([&] { LightLab lab({}, settings); }) == Fault::usage);
  settings.max_current = 130;
  LightLab bright({}, settings);
  bright.light->prepare();
  SimDlpSettings sim;
  sim.current = 200;
  LightLab found(sim);
  CHECK(fault_of([&] { found.light->prepare(); }) == Fault::protocol);
  CHECK(message_of([&] { found.light->prepare(); }).find("above the cap of 100") != std::string::npos);
  LightSettings odd;
  odd.leds = std::string("bx");
  CHECK(fault_of([&] { LightLab lab({}, odd); }) == Fault::usage);
}

TEST_CASE("A gamma that stays on is found by reading back") {
  SimDlpSettings sim;
  sim.stuck_gamma = true;
  LightLab lab(sim);
  CHECK(message_of([&] { lab.light->prepare(); }).find("gamma off was set to 00 but reads back as 80") !=
        std::string::npos);
  CHECK(lab.shining() == 0);
}

TEST_CASE("Each answer of the light engine wrong in turn: the right fault, and never light") {
  const std::vector<std::pair<const char*, Fault>> cases{
      {"silent", Fault::busy},           {"late", Fault::busy},
      {"garbage", Fault::protocol},      {"truncated", Fault::protocol},
      {"wrong-sender", Fault::protocol}, {"error", Fault::protocol},
      {"unplug", Fault::absent}};
  for (const auto& [kind, fault] : cases) {
    for (int after = 0; after < 24; ++after) {
      const bool dlpc900 = after % 2 == 1;
      CAPTURE(kind);
      CAPTURE(after);
      LightLab lab({.dlpc900 = dlpc900, .fault = kind, .fault_after = after / 2});
      CHECK(fault_of([&] { lab.light->prepare(); }) == fault);
      CHECK((lab.log.empty() || lab.shining() == 0));
    }
    // In the middle of a print: the first answer that is wrong ends it, and the order to darken is given all the same.
    LightLab lit({.fault = kind, .fault_after = 40});
    lit.light->prepare();
    lit.light->on();
    std::optional<Fault> found;
    for (int i = 0; i < 40 && !found; ++i) found = fault_of([&] { (void)lit.light->identify(); });
    CHECK(found == fault);
    CHECK(fault_of([&] { lit.light->dark(); }).has_value());
    if (kind != std::string("unplug") && kind != std::string("error")) CHECK(lit.shining() == 0);  // it heard the order
  }
  for (const int command : {0x0200, 0x1A07, 0x1A1B, 0x1A00, 0x1A0E, 0x1A0A, 0x0B01}) {
    SimDlpSettings sim;
    sim.refuse = command;
    LightLab lab(sim);
    CHECK(message_of([&] { lab.light->prepare(); }).find("refused") != std::string::npos);
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/controllers/dlp.hpp"

#include <utility>

#include "base/text/json.hpp"
#include "device/projector/light_engine.hpp"
#include "device/safety/guardian_actions.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;
using namespace vam::sim;

namespace {

struct LightLab {
  explicit LightLab(const SimDlpSettings& sim = {}, const LightSettings& settings = {})
      : light(make_dlp_light(make_sim_dlp(sim, [this](const Json& line) { take(line); }), settings, clock, nullptr)) {}
  void take(const Json& line) { (line["event"] == "leds" ? leds : sleep).push_back(line); }
  // The LEDs that truly shine, by the engine's own log.
  [[nodiscard]] int shining() const { return leds.empty() ? 8 : leds.back()["bits"].get<int>(); }
  std::vector<Json> leds, sleep;
  VirtualClock clock;
  std::unique_ptr<LightEngine> light;
};

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

// What a print sends to an engine, with a third of full current (0x55 steps) and the blue LED.
std::vector<std::string> heard_by(const SimDlpSettings& sim) {
  std::vector<std::string> reports;
  VirtualClock clock;
  LightSettings settings{.current_percent = 33.4};
  const auto light = make_dlp_light(std::make_unique<Heard>(make_sim_dlp(sim, {}), reports), settings, clock, nullptr);
  light->prepare();
  light->on();
  light->standby();
  return reports;
}

}  // namespace

TEST_CASE("light engine starts dark, turns on on command, ends dark") {
  for (const bool dlpc900 : {false, true}) {
    CAPTURE(dlpc900);
    LightLab lab({.dlpc900 = dlpc900, .slow_reads = 3});
    CHECK(lab.light->identify()["firmware"] == "4.0.1");
    lab.light->prepare();
    CHECK(lab.shining() == 0);
    lab.light->on();
    CHECK(lab.shining() == 4);
    CHECK(lab.leds.back()["linear"] == true);
    lab.light->dark();
    CHECK(lab.shining() == 0);
    lab.light->on();
    lab.light->standby();
    CHECK(lab.shining() == 0);
    CHECK(lab.sleep.size() == 1);
  }
}

TEST_CASE("A DLPC900 without an image at its input is given 15 s; its light stays off") {
  LightLab lab({.dlpc900 = true, .no_signal = true});
  const double start_s = lab.clock.now_s();
  const std::string message = error_of([&] { lab.light->prepare(); }, Fault::busy);
  CHECK(has(message, "finds no video signal at its input within 15 s"));
  CHECK(lab.clock.now_s() - start_s == doctest::Approx(15).epsilon(0.01));
  CHECK(lab.shining() == 0);
}

// By hand from TI DLPU010 and DLPU018: flags (40 write, C0 read), sequence, length of what follows, CMD3, CMD2, data.
TEST_CASE(
    "Every byte to a DLPC350: woken, dark, video, gamma off, current; on; LEDs off, then no pattern, then asleep") {
  const std::vector<std::string> wanted{"40010300000200",     "c00202000002",  // power 0: awake
                                        "40030300071a00",     "c0040200071a",  // LED enable 0
                                        "40050300241a00",                      // pattern stop
                                        "400603001b1a00",     "c00702001b1a",  // video mode
                                        "c0080200001a",                        // input source: what it is,
                                        "40090300001a08",     "c00a0200001a",  //   then its port bits 0
                                        "c00b02000e1a",                        // gamma: what it is,
                                        "400c03000e1a00",     "c00d02000e1a",  //   then off
                                        "400e0300051a00",     "c00f0200051a",  // LED polarity: normal
                                        "40100500010baaaaaa", "c0110200010b",  // LED current: 255 less 0x55 steps
                                        "c0120200051a",       "c0130200010b",  // polarity and current, as they are
                                        "c01402000a1a",                        // hardware status
                                        "40150300071a04",     "c0160200071a",  // LED enable: blue
                                        "40170300071a00",     "c0180200071a",  // LED enable 0
                                        "40190300241a00",                      // pattern stop
                                        "401a0300000201"};                     // power 1: asleep
  CHECK(heard_by({}) == wanted);
}

TEST_CASE("Every byte to a DLPC900: its grey is linear in three patterns of 8 bits of each frame") {
  const std::vector<std::string> wanted{"40010300000200",
                                        "c00202000002",  // power 0: awake
                                        "40030300071a00",
                                        "c0040200071a",    // LED enable 0
                                        "40050300241a00",  // pattern stop
                                        "400603001b1a00",
                                        "c00702001b1a",  // video mode
                                        "c0080200001a",  // input source: what it is,
                                        "40090300001a08",
                                        "c00a0200001a",    //   then its port bits 0
                                        "c00b0200011a",    // video receiver: off,
                                        "400c0300011a01",  //   then HDMI
                                        "c00d02000c1a",    // main status: an image
                                        "400e03001b1a02",
                                        "c00f02001b1a",  // video pattern mode
                                        // Pattern, 5500 us, 8 bits and blue (the first: with the frame), dark 0 us,
                                        // trigger out, image 0 and its first bit 0, 8, 16
                                        "40100e00341a00007c1500ce000000000000", "40110e00341a01007c15004e000000000040",
                                        "40120e00341a02007c15004e000000000080",
                                        "40130800311a030000000000",  // three patterns, for ever
                                        "40140300241a02",            // pattern start
                                        "c01502000c1a",              // main status: they run
                                        "40160300051a00",
                                        "c0170200051a",  // LED polarity: normal
                                        "40180500010b555555",
                                        "c0190200010b",  // LED current
                                        "c01a0200051a",
                                        "c01b0200010b",  // polarity and current, as they are
                                        "c01c02000a1a",  // hardware status
                                        "401d0300071a04",
                                        "c01e0200071a",  // LED enable: blue
                                        "401f0300071a00",
                                        "c0200200071a",     // LED enable 0
                                        "40210300241a00",   // pattern stop
                                        "40220300000201"};  // power 1: asleep
  CHECK(heard_by({.dlpc900 = true}) == wanted);
  // A board without a receiver of that kind refuses to tell of it.
  CHECK(has(error_of([] { (void)heard_by({.dlpc900 = true, .refuse = 0x1A01}); }, Fault::busy), "no video signal"));
}

TEST_CASE("An engine that refuses to stop a pattern is still put to sleep") {
  CHECK(heard_by({.refuse = 0x1A24}).back().substr(4) == "0300000201");
}

TEST_CASE("Exit without a command is dark, too") {
  LightLab lab;
  lab.light->prepare();
  lab.light->on();
  CHECK(lab.shining() == 4);
  lab.light.reset();
  CHECK(lab.shining() == 0);
  CHECK(lab.sleep.size() == 1);
}

TEST_CASE("LED current never exceeds the requested value, on either board and from either polarity") {
  for (const bool dlpc900 : {false, true}) {
    for (const bool inverted : {false, true}) {
      for (const double percent : {0.0, 0.5, 1.0, 39.9, 100.0}) {
        CAPTURE(dlpc900);
        CAPTURE(inverted);
        CAPTURE(percent);
        LightSettings settings{.current_percent = percent, .max_current_percent = 100};
        LightLab lab({.dlpc900 = dlpc900, .inverted = inverted}, settings);
        lab.light->prepare();
        lab.light->on();
        const double shines = lab.leds.back()["current_percent"][2];
        CHECK(shines <= percent);
        CHECK(shines > percent - 0.4);  // one of 255 steps
        CHECK(lab.light->identify()["led_current_percent"][2].get<double>() == doctest::Approx(shines).epsilon(0.01));
      }
    }
  }
}

TEST_CASE("The current is capped, as given and as found") {
  LightSettings settings{.current_percent = 41};
  CHECK(has(error_of([&] { LightLab lab({}, settings); }, Fault::usage), "41 % is above the limit of 40 %"));
  settings.max_current_percent = 50;
  LightLab bright({}, settings);
  bright.light->prepare();
  for (const bool dlpc900 : {false, true}) {
    for (const bool inverted : {false, true}) {
      CAPTURE(dlpc900);
      CAPTURE(inverted);
      LightLab found({.dlpc900 = dlpc900, .current_percent = 78, .inverted = inverted});
      CHECK(has(error_of([&] { found.light->prepare(); }, Fault::protocol), "is 78 %, above the limit of 40 %"));
      CHECK(found.shining() == 0);
      LightLab dim({.dlpc900 = dlpc900, .current_percent = 22, .inverted = inverted});
      dim.light->prepare();
    }
  }
  LightLab stuck({.inverted = true, .stuck_polarity = true}, settings);
  CHECK(has(error_of([&] { stuck.light->prepare(); }, Fault::protocol),
            "LED polarity was set to 00 but reads back as 01"));
  LightSettings odd{.leds = std::string("bx")};
  CHECK(fault_of([&] { LightLab lab({}, odd); }) == Fault::usage);
}

TEST_CASE("Grey that stays non-linear is found by reading back") {
  LightLab gamma({.stuck_grey = true});
  CHECK(
      has(error_of([&] { gamma.light->prepare(); }, Fault::protocol), "gamma off was set to 00 but reads back as 80"));
  CHECK(gamma.shining() == 0);
  LightLab mode({.dlpc900 = true, .stuck_grey = true});
  CHECK(has(error_of([&] { mode.light->prepare(); }, Fault::protocol),
            "video pattern mode was set to 02 but reads back as 00"));
  CHECK(mode.shining() == 0);
}

TEST_CASE("Each answer of the light engine wrong in turn: the right fault, and never light") {
  const std::vector<std::pair<const char*, Fault>> cases{
      {"silent", Fault::busy},           {"late", Fault::busy},
      {"garbage", Fault::protocol},      {"truncated", Fault::protocol},
      {"wrong-sender", Fault::protocol}, {"error", Fault::protocol},
      {"unplug", Fault::absent}};
  for (const auto& wrong : cases) {
    const char* kind = wrong.first;
    const Fault fault = wrong.second;
    for (int after = 0; after < 24; ++after) {
      const bool dlpc900 = after % 2 == 1;
      CAPTURE(kind);
      CAPTURE(after);
      LightLab lab({.dlpc900 = dlpc900, .fault = kind, .fault_after = after / 2});
      CHECK(fault_of([&] { lab.light->prepare(); }) == fault);
      CHECK((lab.leds.empty() || lab.shining() == 0));
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
  for (const int command : {0x0200, 0x1A07, 0x1A1B, 0x1A00, 0x1A0E, 0x1A0A, 0x0B01, 0x1A05, 0x1A0C, 0x1A34, 0x1A31}) {
    CAPTURE(command);
    const bool dlpc900 = command == 0x1A0C || command == 0x1A34 || command == 0x1A31;
    LightLab lab({.dlpc900 = dlpc900, .refuse = command});
    CHECK(has(message_of([&] { lab.light->prepare(); }), "refused"));
    CHECK((lab.leds.empty() || lab.shining() == 0));
  }
}

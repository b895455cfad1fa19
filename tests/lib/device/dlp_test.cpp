#include <doctest/doctest.h>

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "device/light_engine.hpp"
#include "device/sim_dlp.hpp"
#include "fault_of.hpp"

using namespace vam;
using namespace vam::device;

namespace {

struct LightLab {
  explicit LightLab(const SimDlpSettings& sim = {}, const LightSettings& settings = {},
                    DlpModel model = DlpModel::dlpc350)
      : light(make_dlp_light(make_sim_dlp(sim, [this](const Json& line) { log.push_back(line); }), model, settings,
                             nullptr)) {}
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

TEST_CASE("Leaving without a word is dark, too") {
  std::vector<Json> log;
  {
    const auto light = make_dlp_light(make_sim_dlp({}, [&](const Json& line) { log.push_back(line); }),
                                      DlpModel::dlpc350, {}, nullptr);
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
    for (int after = 0; after < 12; ++after) {
      CAPTURE(kind);
      CAPTURE(after);
      LightLab lab({.fault = kind, .fault_after = after});
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

#include <doctest/doctest.h>

#include <functional>
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
  for (int after = 0; after < 12; ++after) {
    CAPTURE(after);
    SimDlpSettings silent;
    silent.silent_after = after;
    LightLab quiet(silent);
    CHECK(fault_of([&] { quiet.light->prepare(); }) == Fault::busy);
    SimDlpSettings noise;
    noise.garble_after = after;
    LightLab noisy(noise);
    CHECK(fault_of([&] { noisy.light->prepare(); }) == Fault::protocol);
  }
  for (const int command : {0x0200, 0x1A07, 0x1A1B, 0x1A00, 0x1A0E, 0x1A0A, 0x0B01}) {
    SimDlpSettings sim;
    sim.refuse = command;
    LightLab lab(sim);
    CHECK(message_of([&] { lab.light->prepare(); }).find("refused") != std::string::npos);
  }
}

TEST_CASE("A lamp that cannot be darkened any more is an error, and the order is given all the same") {
  SimDlpSettings sim;
  sim.silent_after = 40;
  LightLab lab(sim);
  lab.light->prepare();
  lab.light->on();
  std::optional<Fault> fault;
  for (int i = 0; i < 40 && !fault; ++i) fault = fault_of([&] { (void)lab.light->identify(); });
  CHECK(fault == Fault::busy);
  CHECK(fault_of([&] { lab.light->dark(); }) == Fault::busy);
  CHECK(lab.shining() == 0);  // it heard the order; only its answer was lost
}

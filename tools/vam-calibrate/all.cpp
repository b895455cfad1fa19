// SPDX-License-Identifier: GPL-3.0-or-later
// All scans in the order of their dependence: frames of each are taken and measured.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "cli/companion.hpp"
#include "device/os/clock.hpp"
#include "device/os/interrupt.hpp"
#include "model/device_schemes.hpp"
#include "session/printer.hpp"
#include "vam-calibrate/bench.hpp"
#include "vam-calibrate/scan.hpp"

namespace vam::calibrate_tool {

namespace {

std::string text(double number) { return format_number(number, 4); }
std::string whole(double number) { return std::to_string(static_cast<long>(number)); }

/// Frames of a pattern; a scan of what it lights is told apart from what is seen in the dark.
struct Shot {
  Words pattern, frames;
  bool dark = false;
  Words record = {};
};

void take(Bench& bench, const Shot& shot) {
  Words record{"--flips", bench.file("flips")};
  if (shot.dark) {
    bench.capture("dark", {"--frames", "30"});
    record.insert(record.end(), {"--dark", bench.file("dark.exr")});
  }
  bench.light(shot.pattern);
  bench.capture(std::filesystem::path(bench.frames()).stem(), shot.frames);
  bench.end();
  record.insert(record.end(), shot.record.begin(), shot.record.end());
  bench.measure(record);
}

// A bead that turns both ways: the delay of the time stamps, for which later frames are corrected.
void take_lag(Bench& bench) {
  constexpr int turns = 5;
  const double speed = bench.brisk_deg_s();
  const double step_deg = std::max(3.0, 6 * speed / bench.printer.camera.fps);  // of six frames five may be lost
  const Words views{"--lag", "0", "--view-step", text(step_deg), "--turns", std::to_string(turns)};
  std::filesystem::remove(bench.file("angles.jsonl"));
  bench.turn("lag", turns, {"--direction", "1", "--speed", text(speed)}, views);
  bench.turn("reverse", turns, {"--direction", "-1", "--speed", text(speed)}, views);
  bench.measure({bench.file("reverse.exr"), "--follow", bench.file("angles.jsonl")});
  bench.correct_lag();
}

// In a sequence without a period, at a rate that does not keep step with the screen's.
void take_latency(Bench& bench) {
  constexpr double most_hz = 120;
  const double hz = 0.93 * std::min(bench.printer.camera.fps, most_hz);
  take(bench, {{"blink", "--hold", "0.02"}, {"--frames", "150", "--fps", text(hz)}});
}

// An even target stands in the vial's place.
void take_flat(Bench& bench) { take(bench, {{"grey"}, {"--frames", "40"}, true}); }

// Five frames a level and the change between two.
void take_response(Bench& bench) {
  constexpr int levels = 17;
  const double fps = bench.printer.camera.fps;
  const std::string hold_s = text(6 / fps + 0.1);
  take(bench, {{"ramp", "--steps", std::to_string(levels), "--hold", hold_s},
               {"--frames", whole(levels * std::stod(hold_s) * fps + 8)},
               true});
}

// A bead, or the vial's edges against a bright background, over a turn; the projector stays dark.
void take_axis(Bench& bench) {
  bench.turn("axis", 1, {}, {"--view-step", "10", "--turns", "1"});
  bench.measure({});
}

// A lit row through the resin: one image holds all planes.
void take_beam(Bench& bench) { take(bench, {{"row"}, {"--frames", "40"}, true, {"--side"}}); }

// At four stage angles, so that the axis and the wobble round it are distinguished.
void take_edges(Bench& bench) {
  const int columns = bench.printer.projector.columns;
  const double fps = bench.printer.camera.fps;
  constexpr int most = 128;
  const int pitch = bench.options.pitch_px.value_or((columns + most - 1) / most);
  const Words line{"--pitch", std::to_string(pitch), "--width", std::to_string(2 * pitch)};
  const std::string hold_s = text(3 / fps + 0.05);
  const int positions = columns / pitch + 2;
  std::filesystem::remove(bench.frames());
  for (const int angle_deg : {0, 90, 180, 270}) {
    bench.move(angle_deg);
    bench.light({"sweep", line[0], line[1], line[2], line[3], "--hold", hold_s});
    bench.capture("sweep",
                  {"--angle", std::to_string(angle_deg), "--frames", whole(positions * std::stod(hold_s) * fps + 8)});
    bench.end();
    std::ofstream all(bench.frames(), std::ios::binary | std::ios::app);
    all << std::ifstream(bench.file("sweep.exr"), std::ios::binary).rdbuf() << std::flush;
    if (!all) throw Error{Fault::io, bench.frames() + ": cannot be written; free space on the disk"};
    std::filesystem::remove(bench.file("sweep.exr"));
  }
  Words record{"--flips", bench.file("flips"), line[0], line[1], line[2], line[3]};
  if (bench.options.accept) record.emplace_back("--accept");
  bench.measure(record);
}

struct ScanStep {
  std::string_view name;
  void (*take)(Bench& bench);
  bool dim = false;  // exposed as --sweep-exposure says
};

// In the order of their dependence.
constexpr std::array<ScanStep, 7> in_order{{{"lag", take_lag},
                                            {"latency", take_latency},
                                            {"flat", take_flat},
                                            {"response", take_response},
                                            {"axis", take_axis},
                                            {"beam", take_beam, true},
                                            {"edges", take_edges, true}}};

std::vector<ScanStep> wanted_steps(const std::string& names) {
  Words wanted;
  for (const std::string& part : split(names, ',')) {
    for (const std::string& name : split(part, ' ')) wanted.push_back(name);
  }
  std::erase(wanted, "");
  if (wanted.empty()) throw Error{Fault::usage, "--scans: empty; see --help"};
  Words known;
  for (const ScanStep& step : in_order) known.emplace_back(step.name);
  for (const std::string& name : wanted) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error{Fault::usage, "--scans: '" + name + "' is not one of " + join(known, ", ")};
  }
  std::vector<ScanStep> chosen(in_order.begin(), in_order.end());
  std::erase_if(
      chosen, [&](const ScanStep& step) { return std::find(wanted.begin(), wanted.end(), step.name) == wanted.end(); });
  return chosen;
}

// Lost frames, a late answer, a device in use; a delay that a busy machine has measured badly.
bool is_passing(const Failed& failed) {
  const auto says = [&](const char* words) { return failed.said.find(words) != std::string::npos; };
  return failed.status == static_cast<int>(Fault::busy) ||
         (failed.status == static_cast<int>(Fault::judged) &&
          (says("lag: standard deviation") || says("latency: standard deviation")));
}

bool is_over_exposed(const Failed& failed) {
  return failed.status == static_cast<int>(Fault::data) && failed.said.find(" are over-exposed") != std::string::npos;
}

// As a person would: again, and with a shorter exposure, in whole steps of the camera's.
void take_with_patience(Bench& bench, const ScanStep& step) {
  constexpr double pause_s = 2;
  const double step_us = bench.printer.camera.device.starts_with("v4l2:") ? 100 : 1;
  bench.exposure_us = step.dim ? bench.options.sweep_exposure_us.value_or(bench.printer.camera.exposure_us)
                               : bench.printer.camera.exposure_us;
  for (int exposures = 1, repeats = 0;;) {
    try {
      return step.take(bench);
    } catch (const Failed& failed) {
      bench.end();
      if (is_over_exposed(failed) && bench.exposure_us > step_us && ++exposures <= 6) {
        bench.exposure_us = step_us * std::max(1.0, std::floor(0.4 * bench.exposure_us / step_us));
        bench.note("over-exposed", {{"exposure_us", bench.exposure_us}});
      } else if (is_passing(failed) && ++repeats <= 2) {
        bench.note("repeated", {{"status", failed.status}, {"attempt", repeats}});
        device::real_clock().sleep_until(device::real_clock().now_s() + pause_s);
      } else {
        throw;
      }
    }
  }
}

// Returns the exit status.
int take_all(const AllOptions& options) {
  const std::vector<ScanStep> chosen = wanted_steps(options.scans);
  Bench bench(options);
  try {
    take_with_patience(bench, {"", [](Bench& all) { all.identify(); }});
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      bench.begin(std::string(chosen[i].name),
                  "scan " + std::to_string(i + 1) + " of " + std::to_string(chosen.size()));
      bench.note("begin", Json::object());
      take_with_patience(bench, chosen[i]);
      bench.note("end", Json::object());
    }
    return 0;
  } catch (const Failed& failed) {
    bench.end();
    bench.note("failed", {{"status", failed.status}});
    for (const std::string& line : split(trimmed(failed.said, "\n"), '\n')) device::pass_on(line);
    return failed.status;
  }
}

void declare(cli::App& app, AllOptions& o) {
  app.option("--display", "DEVICE", o.display, "Display for the patterns: drm:HDMI-A-1, sdl:0.").required();
  app.option("--light", "DEVICE", o.light, "Light engine: " + model::forms_of(model::light_schemes) + ".");
  app.option("--scans", "NAMES", o.scans,
             "Names of the scans, separated by commas: lag, latency, flat, response, axis, beam, edges; they run in "
             "this order.");
  app.flag("--accept", o.accept, "Accept a vial that moved or changed since the previous record.");
  app.flag("--home", o.home, "Find the reference of the stage first; edges requires it.");
  app.option("--pitch", "PX", o.pitch_px, {1, 1000}, "Step of the sweep, whose line is twice as wide.")
      .default_is("columns / 128");
  app.option("--sweep-exposure", "US", o.sweep_exposure_us, cli::positive,
             "Camera exposure of the scans with a dim line (beam, edges). A scan whose frames are over-exposed is "
             "repeated with 0.4 times the exposure, at most five times; one that lost frames, had a late reply or a "
             "device in use, or measured a delay with too large a standard deviation, at most twice.")
      .default_is("camera.exposure_us");
  app.option("--keep", "DIR", o.keep,
             "Work in this folder and keep there the frames (SCAN.exr, dark.exr), the log of vam-project (flips), the "
             "angles of the stage (angles.jsonl), settings and identities (printer.toml, devices.json).")
      .default_is("a temporary folder, which is removed");
  app.option("--log", "FILE", o.log, "Append one JSON line per event; - is standard error.");
  cli::add_printer(app, o.printer);
}

}  // namespace

void add_all(cli::App& app, int& status) {
  const auto options = std::make_shared<AllOptions>();
  declare(app.subcommand("all", "take the frames of all scans and measure them, in the order of their dependence",
                         [options, &status] {
                           if (session::print_printer(options->printer)) return;
                           const auto names = [&](const auto& one) {
                             return options->display.starts_with(std::string(one.scheme) + ":");
                           };
                           if (std::none_of(model::display_schemes.begin(), model::display_schemes.end(), names)) {
                             throw Error{Fault::usage, "--display: '" + options->display + "' is not one of " +
                                                           model::forms_of(model::display_schemes)};
                           }
                           cli::find_tools_beside();
                           device::supervise();
                           device::interruptible([&] { status = take_all(*options); });
                         }),
          *options);
}

}  // namespace vam::calibrate_tool

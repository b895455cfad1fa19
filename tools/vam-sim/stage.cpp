// SPDX-License-Identifier: GPL-3.0-or-later
// vam-sim stage: a controller with a rotation stage, or the relay of a lamp, on a pseudo-terminal.
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "cli/app.hpp"
#include "cli/companion.hpp"
#include "device/os/interrupt.hpp"
#include "device/os/process.hpp"
#include "device/port/lines.hpp"
#include "sim/controllers/controllers.hpp"
#include "sim/controllers/pty_host.hpp"
#include "vam-sim/commands.hpp"

namespace vam::sim_tool {

namespace {

struct Protocol {
  const char* name;
  decltype(&sim::make_sim_gcs) make;
};
constexpr Protocol protocols[] = {{"gcs", sim::make_sim_gcs},
                                  {"grbl", sim::make_sim_grbl},
                                  {"zaber", sim::make_sim_zaber},
                                  {"relay", sim::make_sim_relay}};

std::vector<std::string> protocol_names() {
  std::vector<std::string> names;
  for (const Protocol& protocol : protocols) names.emplace_back(protocol.name);
  return names;
}

struct StageOptions {
  sim::SimGcsSettings stage;
  double reply_delay_ms = 0.5;
  double jitter_ms = 0;
  int seed = 1;
  std::optional<int> baud;
  std::vector<std::string> faults;
  std::string log;
  std::string link;
  std::string protocol = "gcs";
  bool shim = false;
  bool with_parent = false;
};

void declare(cli::App& app, StageOptions& options) {
  auto& motor = options.stage.motor;
  app.group("Stage");
  app.option("--acceleration", "DEG/S2", motor.acceleration_deg_s2, {1, 10000},
             "Acceleration of ramps and smooth stops.");
  app.option("--speed-error", "FRACTION", motor.speed_error, {-0.5, 0.5},
             "Relative speed error: 0.01 is 1 % too fast.");
  app.option("--ripple", "FRACTION", motor.ripple, {0, 0.5},
             "Relative amplitude of a speed ripple with a period of 30 degrees.");
  app.option("--max-speed", "DEG/S", options.stage.max_speed_deg_s, {1, 10000},
             "Maximum speed; commands above it are rejected with error 8.");
  app.option("--min-angle", "DEG", options.stage.min_deg, {-1e7, 0},
             "Lower limit of travel; commands below it are rejected with error 7.");
  app.option("--max-angle", "DEG", options.stage.max_deg, {0, 1e7}, "Upper limit of travel.");
  app.option("--start-angle", "DEG", options.stage.home_deg, {-180, 180}, "Angle at power-on, from the reference.");
  app.group("Serial line");
  app.choice(
      "--protocol", options.protocol, protocol_names(),
      "Device: a PI controller (gcs), a GRBL 1.1 board with the stage on axis X, a Zaber rotary stage, or the dead-man "
      "relay of a lamp.");
  app.option("--reply-delay", "MS", options.reply_delay_ms, {0, 1000}, "Delay of replies.");
  app.option("--jitter", "MS", options.jitter_ms, {0, 1000},
             "Additional random delay, before and after the angle is sampled.");
  app.option("--baud", "BAUD", options.baud, {50, 4000000}, "Accept only this baud rate.");
  app.option("--address", "N", options.stage.address, {1, 99},
             "Address of the controller in a daisy chain (GCS: 16 at most).");
  app.flag("--reset-at-open", options.stage.reset_at_open,
           "GRBL: the board is reset when its port is opened, as most boards are, and loses its position.");
  app.flag("--no-switches", options.stage.no_switches,
           "GRBL: the board has no homing switches ($22=0) and refuses to home.");
  app.flag("--old-firmware", options.stage.old_firmware, "Zaber: firmware 6.28, whose motion commands have no speed.");
  app.option("--fault", "FAULT", options.faults, "Inject a fault, as KIND@COMMAND[:N].");
  app.group("Program");
  app.option("--seed", "N", options.seed, {0, 1e9}, "Seed of the random numbers.");
  app.option("--log", "FILE", options.log, "Append one JSON line per event; - is standard error.");
  app.option("--link", "FILE", options.link, "Symbolic link to the pseudo-terminal, removed at the end.");
  app.flag("--shim", options.shim, "Print the path of the library to preload and exit.");
  app.flag("--die-with-parent", options.with_parent, "Exit when the parent process exits.");
  app.usual({"--max-speed", "--start-angle", "--protocol", "--address", "--fault", "--seed", "--log", "--link"});
}

class Link {
 public:
  Link(const std::string& path, const std::string& target) : path_(path) {
    if (path.empty()) return;
    std::error_code problem;
    if (std::filesystem::is_symlink(path)) std::filesystem::remove(path, problem);
    std::filesystem::create_symlink(target, path, problem);
    if (problem) throw Error{Fault::no_output, path + ": cannot create the link (" + problem.message() + ")"};
  }
  ~Link() {
    std::error_code none;
    if (!path_.empty()) std::filesystem::remove(path_, none);
  }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

 private:
  std::string path_;
};

void simulate(StageOptions& options) {
  if (options.shim) return device::print_line(cli::companion("vam-pty-shim.so"));
  if (options.with_parent) device::end_with_parent();
  options.stage.latency_s = 1e-3 * options.reply_delay_ms;
  options.stage.jitter_s = 1e-3 * options.jitter_ms;
  options.stage.seed = static_cast<std::uint64_t>(options.seed);
  for (const auto& fault : options.faults) options.stage.faults.push_back(sim::parse_sim_fault(fault));
  const auto* protocol = std::find_if(std::begin(protocols), std::end(protocols),
                                      [&](const Protocol& one) { return one.name == options.protocol; });
  const auto stage = protocol->make(options.stage, device::real_clock().now_s(), sim::file_sim_log(options.log));
  sim::Pty pty;
  const Link link(options.link, pty.path());
  device::print_line(pty.path());
  device::hurry(device::Urgency::driver);  // a controller has no other task
  sim::serve(pty, *stage, options.baud);
}

void run(const cli::App& /*app*/, StageOptions& options) {
  device::interruptible([&] { simulate(options); });
}

}  // namespace

void add_stage(cli::App& app) {
  app.subcommand<StageOptions>("stage", "simulate a rotation stage on a pseudo-terminal", declare, run);
}

}  // namespace vam::sim_tool

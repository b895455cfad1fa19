// SPDX-License-Identifier: GPL-3.0-or-later
// vam-stage: turns the rotation stage and reports its angle.
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/log/chain.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "cli/app.hpp"
#include "device/open/open.hpp"
#include "device/os/event_log.hpp"
#include "device/os/interrupt.hpp"
#include "device/os/process.hpp"
#include "device/port/lines.hpp"
#include "device/port/serial_port.hpp"
#include "device/stage/spin.hpp"
#include "io/settings/printer_file.hpp"
#include "manual_page.hpp"
#include "model/device_schemes.hpp"
#include "session/printer.hpp"

namespace {

using namespace vam;

struct Options {
  std::string device;  // empty: stage.device
  std::string log;
  bool with_parent = false;
  double angle_deg = 0;
  bool relative = false;
  bool home_first = false;
  bool abrupt = false;
  bool only_plan = false;
  double timeout_s = 120;
  std::optional<double> duration_s;
  double rate_hz = 100;
  std::optional<double> speed_deg_s;
  std::optional<int> turns;  // of a spin; absent: of the printer file
  std::string direction;     // likewise when empty
  device::SpinPlan plan;
  cli::PrinterOptions printer;
};

// Unset options come from the printer file; calibration records do not concern the stage.
void resolve(Options& options) {
  const model::PrinterStage stage =
      io::load_printer(options.printer.file, options.printer.sets, io::Records::ignore).stage;
  if (options.device.empty()) options.device = stage.device;
  options.plan.turns = options.turns.value_or(stage.turns);
  options.plan.speed_deg_s = options.speed_deg_s.value_or(stage.speed_deg_s);
  options.plan.direction = options.direction.empty() ? stage.direction : options.direction == "1" ? 1 : -1;
  options.plan.period_s = 1 / options.rate_hz;
}

std::string plan_text(device::Stage& stage, const Options& options) {
  const device::SpinCourse course = plan_spin(stage, options.plan, options.home_first);
  const int turns = options.plan.turns;
  return std::to_string(turns) + (turns == 1 ? " turn at " : " turns at ") + format_number(options.plan.speed_deg_s) +
         " deg/s: from " + format_number(course.start_deg) + " to " + format_number(course.end_deg) + " deg, within " +
         format_number(course.min_deg) + " to " + format_number(course.max_deg) + "; " +
         format_number(course.seconds, 4) + " s with ramp and run-up";
}

void drive(const std::string& command, Options& options) {
  if (session::print_printer(options.printer)) return;
  resolve(options);
  if (options.with_parent) device::end_with_parent();
  device::Guardian guardian;
  device::EventLog log(options.log);
  auto& clock = device::real_clock();
  const auto stage = device::open_stage(options.device, clock, &guardian);
  const auto print = [first = true, chain = std::string()](const device::AngleSample& sample) mutable {
    device::print_line(chained(to_line(sample, std::exchange(first, false)), chain));
  };
  device::hurry(device::Urgency::driver);
  Json begin{{"command", command}, {"device", options.device}};
  if (!options.log.empty() && device::describe(*stage).contains("simulated")) begin["simulated"] = true;
  log("begin", begin);
  if (options.only_plan) return device::print_line(plan_text(*stage, options));
  if (command == "home" && !stage->keeps_zero()) {
    throw Error{Fault::data, "stage: home=here: its zero lasts for one command; give --home to spin"};
  }
  if (command == "home" || options.home_first) device::home(*stage, clock, options.timeout_s);
  const std::map<std::string, std::function<void()>> actions{
      {"home", [] {}},
      {"identify", [&] { device::print_line(describe(*stage).dump(2)); }},
      {"status", [&] { device::print_line(status(*stage).dump(2)); }},
      {"move",
       [&] { move(*stage, clock, options.angle_deg, options.relative, options.plan.speed_deg_s, options.timeout_s); }},
      {"spin", [&] { spin(*stage, clock, options.plan, print); }},
      {"stop", [&] { halt(*stage, clock, options.abrupt ? device::Stop::abrupt : device::Stop::smooth); }},
      {"follow", [&] { follow(*stage, clock, options.plan.period_s, options.duration_s, print); }}};
  actions.at(command)();
  log("end", {{"command", command}});
}

/// A command that works on the stage.
cli::App& add_command(cli::App& app, Options& options, const std::string& name, const std::string& summary) {
  auto& command = app.subcommand(name, summary, [&options, name] {
    device::interruptible([&] { device::logged(options.log, [&] { drive(name, options); }); });
  });
  command
      .option("--device", "DEVICE", options.device,
              "Rotation stage: " + model::forms_of(model::stage_schemes) + ", with options after a question mark.")
      .default_is("stage.device");
  command.option("--log", "FILE", options.log,
                 "Append one JSON line per event, with UTC and monotonic time; - is standard error.");
  command.flag("--die-with-parent", options.with_parent, "Stop the stage and exit when the parent process exits.");
  cli::add_printer(command, options.printer);
  return command;
}

void add_speed(cli::App& command, Options& options) {
  command.option("--speed", "DEG/S", options.speed_deg_s, {0.001, 1000}, "Stage speed.")
      .default_is("stage.speed_deg_s");
}

void add_rate(cli::App& command, Options& options) {
  command.option("--rate", "HZ", options.rate_hz, {1, 1000}, "Samples per second.");
}

void add_home(cli::App& command, Options& options) {
  command.flag("--home", options.home_first, "Find the reference first.");
}

void add_move(cli::App& app, Options& options) {
  auto& move = add_command(app, options, "move", "turn to an angle and wait for standstill");
  move.option("--angle", "DEG", options.angle_deg, {-1e6, 1e6}, "Target angle; it may exceed 360 degrees.").required();
  move.flag("--relative", options.relative, "The angle is relative to the present one.");
  add_home(move, options);
  add_speed(move, options);
  move.option("--timeout", "S", options.timeout_s, {1, 86400}, "Maximum duration of the motion.");
}

void add_spin(cli::App& app, Options& options) {
  auto& spin =
      add_command(app, options, "spin", "ramp, run-up turn, whole turns, stop; print one JSON line per sample");
  spin.option("--turns", "N", options.turns, {1, 100000}, "Turns of the print, after the run-up.")
      .default_is("stage.turns");
  add_speed(spin, options);
  spin.option("--run-up", "TURNS", options.plan.run_up_turns, {0, 100}, "Turns at full speed before angle 0.");
  spin.choice(
          "--direction", options.direction, {"1", "-1"},
          "Direction of rotation: 1 is clockwise seen from above, -1 counterclockwise. The reported angle increases "
          "in both cases.")
      .default_is("stage.direction");
  spin.option("--speed-tolerance", "FRACTION", options.plan.speed_tolerance, {1e-6, 1},
              "Maximum relative speed error before angle 0.");
  add_rate(spin, options);
  add_home(spin, options);
  spin.flag("--plan", options.only_plan, "Print travel, limits and duration of this motion, and do not move.");
}

void add_commands(cli::App& app, Options& options) {
  add_command(app, options, "identify", "print the controller, its limits and its firmware as JSON");
  add_command(app, options, "status", "print angle, motion and pending error as JSON");
  app.subcommand("ports", "print the serial ports of this machine as JSON",
                 [] { device::print_line(device::list_serial_ports().dump(2)); });
  auto& home = add_command(app, options, "home", "find the reference, which becomes 0 degrees");
  home.option("--timeout", "S", options.timeout_s, {1, 3600}, "Maximum duration of the search.");
  add_move(app, options);
  add_spin(app, options);
  auto& stop = add_command(app, options, "stop", "stop the stage and wait for standstill");
  stop.flag("--abrupt", options.abrupt, "Stop as fast as the controller can, instead of its normal deceleration.");
  auto& follow = add_command(app, options, "follow", "print one JSON line per sample without motion");
  add_rate(follow, options);
  follow.option("--duration", "S", options.duration_s, cli::positive, "Duration.").default_is("until a signal");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  cli::App app({"vam-stage", "turn the rotation stage and report its angle", manual_page, cli::device_statuses});
  add_commands(app, options);
  return app.run(argc, argv);
}

// vam-stage: turns the rotation stage and says where it is.
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/json.hpp"
#include "cli/app.hpp"
#include "device/open/stage.hpp"
#include "device/os/event_log.hpp"
#include "device/os/interrupt.hpp"
#include "device/os/realtime.hpp"
#include "device/port/lines.hpp"
#include "device/port/serial_port.hpp"
#include "device/stage/spin.hpp"

namespace {

using namespace vam;

struct Options {
  std::string device = "sim:";
  std::string log;
  bool with_parent = false;
  double angle_deg = 0;
  bool relative = false;
  bool home_first = false;
  bool abrupt = false;
  double timeout_s = 120;
  std::optional<double> seconds;
  double rate_hz = 100;
  double move_speed_deg_s = 10;
  device::SpinPlan plan;
};

cli::Manual manual() {
  return {
      "vam-stage",
      "turn the rotation stage and report its angle",
      {"Drives a rotation stage and prints where it is. spin makes the motion of a print: it ramps up, turns one "
       "run-up turn at constant speed, then the whole turns of the print, and stops. While it turns it prints one JSON "
       "line a sample, {\"t_monotonic_s\": ..., \"angle_deg\": ..., \"sigma\": ...}: the time on CLOCK_MONOTONIC, "
       "which all processes of the machine share, the angle at that time, and its standard deviation in degrees. "
       "vam-project --follow reads these lines. The angle is 0 where the light may go on, negative before, and 360 "
       "times the turns where it must be off again. An angle of 0 is always the same position of the table: its "
       "reference after home.",
       "A device is a scheme, a place and options. gcs:/dev/ttyUSB0 is a PI controller (General Command Set 2.0, for "
       "example C-863 with M-060.PD) on a serial or USB port; its baud rate is found by asking unless ?baud=115200 is "
       "given; ?address=2 talks to one controller of a daisy chain and ?axis=NAME to an axis of another name. "
       "grbl:/dev/ttyACM0 is a GRBL 1.1 board with the table on axis X, in degrees (?axis=Y for another). "
       "tic:00312345?steps_per_deg=88.9 is a stepper motor behind a Pololu Tic on USB; the serial number may be left "
       "out when there is one. sim: is the PI controller simulated inside the tool; its options speed_error, ripple "
       "(relative), jitter_ms, latency_ms, acceleration_deg_s2, travel_deg, home_deg, seed, fault and log make it as "
       "bad as wanted. vam-sim-stage(1) puts this simulator behind a pseudo-terminal.",
       "A device has one user at a time: the second one exits with status 75 and names the process that has it."},
      {{"Which controller is it, and what can it do?", "vam-stage identify"},
       {"Find the reference and turn to 20 degrees from it", "vam-stage move --home --to 20"},
       {"A turn of a simulated stage that is 1 % too fast and answers up to 5 ms late",
        "vam-stage spin --device 'sim:?speed_error=0.01&jitter_ms=5' --speed 90 --run-up 0.25 --rate 10 "
        ">angles.jsonl"}},
      {"Safety. Before the table moves, a child process (the guardian) holds the order to stop it. When vam-stage dies "
       "of anything, SIGKILL and a crash included, or makes no progress for 0.5 s, the guardian sends the order: the "
       "table begins to stop within 100 ms. This is software and no interlock: it needs a running kernel and a plugged "
       "cable. A cable that is pulled leaves the controller to finish its last motion, which is never longer than the "
       "turns asked for. Wire a hardware interlock that cuts the light and the motor where people can reach either.",
       "Accuracy. A sample's time is the middle of question and answer; sigma is what the time between them leaves "
       "open. spin refuses to begin printing (status 76) when the speed is off by more than --speed-tolerance, and "
       "ends when the table leaves its own line by more than 2 degrees. The port's latency matters: at 25 deg/s, 16 ms "
       "(the FTDI default, which is set to 1 ms where permitted) are 0.4 degrees.",
       "Priority. On a machine that is busy with other things an answer may be read too late to be of use. As root, or "
       "with leave for a real-time priority of 2 (a line `@dialout - rtprio 2` in /etc/security/limits.d/vam.conf, for "
       "the "
       "members of that group from their next login), vam-stage and its guardian go before all others.",
       "Files. Locks are kept in $VAM_LOCK_DIR, /run/lock or /tmp."},
      {"vam-project", "vam-sim-stage", "vam-capture"},
      {},
      cli::device_statuses};
}

void add_common(cli::App& command, Options& options) {
  command.option("--device", "DEVICE", options.device,
                 "Rotation stage: " + device::stage_devices() + ", with options after a question mark.");
  command.option("--log", "FILE", options.log,
                 "Append one JSON line per event, with UTC and monotonic time; - for standard error.");
  command.flag("--die-with-parent", options.with_parent, "Stop and end when the process that started this one ends.");
}

void add_commands(cli::App& app, Options& options, std::string& chosen) {
  add_common(app.subcommand("identify", "print the controller, its limits and its firmware as JSON", chosen), options);
  add_common(app.subcommand("status", "print angle, motion and pending error as JSON", chosen), options);
  app.subcommand("ports", "print the serial ports of this machine as JSON", chosen);
  auto& home = app.subcommand("home", "find the reference; it becomes 0 degrees", chosen);
  add_common(home, options);
  home.option("--timeout", "S", options.timeout_s, {1, 3600}, "Give up after so many seconds.");
  auto& move = app.subcommand("move", "turn to an angle and wait until the table stands", chosen);
  add_common(move, options);
  move.option("--to", "DEG", options.angle_deg, {-1e6, 1e6}, "The angle; several turns are several times 360.");
  move.flag("--relative", options.relative, "The angle counts from where the table is.");
  move.flag("--home", options.home_first, "Find the reference first.");
  move.option("--speed", "DEG/S", options.move_speed_deg_s, {0.001, 1000}, "Speed of the table.");
  move.option("--timeout", "S", options.timeout_s, {1, 86400}, "Give up after so many seconds.");
  auto& spin = app.subcommand("spin", "ramp, run-up turn, whole turns, stop; print one JSON line a sample", chosen);
  add_common(spin, options);
  spin.option("--turns", "N", options.plan.turns, {1, 100000}, "Turns of the print, after the run-up.");
  spin.option("--speed", "DEG/S", options.plan.speed_deg_s, {0.001, 1000}, "Speed of the table.");
  spin.option("--run-up", "TURNS", options.plan.run_up_turns, {0, 100}, "Turns at full speed before angle 0.");
  spin.option("--direction", "SIGN", options.plan.direction, {-1, 1},
              "1, or -1 for the other way; the angle printed grows either way.");
  spin.option("--speed-tolerance", "PART", options.plan.speed_tolerance, {1e-6, 1},
              "Largest relative error of the speed before angle 0.");
  spin.option("--rate", "HZ", options.rate_hz, {1, 1000}, "Samples a second.");
  spin.flag("--home", options.home_first, "Find the reference first.");
  auto& stop = app.subcommand("stop", "stop the table and wait until it stands", chosen);
  add_common(stop, options);
  stop.flag("--abrupt", options.abrupt, "As hard as the controller can, instead of its normal deceleration.");
  auto& follow = app.subcommand("follow", "print one JSON line a sample without moving anything", chosen);
  add_common(follow, options);
  follow.option("--rate", "HZ", options.rate_hz, {1, 1000}, "Samples a second.");
  follow.option("--seconds", "S", options.seconds, cli::positive, "End after so long; without it, at a signal.");
}

void drive(const std::string& command, Options& options) {
  if (options.plan.direction == 0) throw Error{Fault::usage, "--direction: give 1 or -1"};
  if (command == "ports") return device::print_line(device::list_serial_ports().dump(2));
  if (options.with_parent) device::end_with_parent();
  device::Guardian guardian;
  device::EventLog log(options.log);
  auto& clock = device::real_clock();
  const auto stage = device::open_stage(options.device, clock, &guardian);
  const auto print = [](const device::AngleSample& sample) { device::print_line(to_line(sample)); };
  options.plan.period_s = 1 / options.rate_hz;
  device::hurry(device::Urgency::driver);
  log("begin", {{"command", command}, {"device", options.device}});
  if (command == "home" || options.home_first) device::home(*stage, clock, options.timeout_s);
  const std::map<std::string, std::function<void()>> actions{
      {"home", [] {}},
      {"identify", [&] { device::print_line(describe(*stage).dump(2)); }},
      {"status", [&] { device::print_line(status(*stage).dump(2)); }},
      {"move",
       [&] { move(*stage, clock, options.angle_deg, options.relative, options.move_speed_deg_s, options.timeout_s); }},
      {"spin", [&] { spin(*stage, clock, options.plan, print); }},
      {"stop", [&] { halt(*stage, clock, options.abrupt ? device::Stop::abrupt : device::Stop::smooth); }},
      {"follow", [&] { follow(*stage, clock, options.plan.period_s, options.seconds, print); }}};
  actions.at(command)();
  log("end", {{"command", command}});
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  std::string command;
  cli::App app(manual());
  add_commands(app, options, command);
  return app.run(argc, argv, [&] {
    device::interruptible([&] { device::logged(options.log, [&] { drive(command, options); }); });
  });
}

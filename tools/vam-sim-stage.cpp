// vam-sim-stage: a PI controller with a rotation stage on a pseudo-terminal.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "cli/app.hpp"
#include "device/os/interrupt.hpp"
#include "device/os/realtime.hpp"
#include "device/port/lines.hpp"
#include "sim/controllers/grbl.hpp"
#include "sim/controllers/options.hpp"
#include "sim/controllers/pty_host.hpp"

namespace {

using namespace vam;

struct Options {
  sim::SimGcsSettings stage;
  double latency_ms = 0.5;
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

cli::Manual manual() {
  return {
      "vam-sim-stage",
      "simulate a rotation stage on a pseudo-terminal",
      {"Behaves like a PI C-863 controller with an M-060.PD rotation stage on a serial line: it opens a "
       "pseudo-terminal, prints its path, and answers GCS 2.0 commands until a signal ends it. The table has inertia "
       "and limits, must be switched on and referenced, and refuses with the error codes of the controller.",
       "Its log tells what really happened, to judge the tools by: one JSON line per command received, per start, "
       "standstill and zeroing of the table, and the true angle every 10 ms while it moves, all on CLOCK_MONOTONIC.",
       "libserialport, which vam-stage uses, accepts no pseudo-terminals; a small library to preload changes its mind. "
       "--shim prints where it is."},
      {{"A stage, asked who it is",
        "vam-sim-stage --link stage --die-with-parent >path & while [ ! -s path ]; do sleep 0.1; done; "
        "LD_PRELOAD=$(vam-sim-stage --shim) vam-stage identify --device gcs:$(cat path)"}},
      {"Faults. --fault KIND@COMMAND[:N] spoils the N-th arrival of a command (POS?, MOV, ERR?, #7, ...): garbage, "
       "truncated, late (3 s) or silent answers, wrong-sender (an answer of controller 7), error (the command is "
       "refused), unplug (the cable is pulled; the motion goes on, as with the real one) and power-loss (the "
       "controller dies and the table coasts to a stop) and block (the table is held fast while the controller talks "
       "on)."},
      {"vam-stage", "vam-sim-camera"},
      {},
      cli::device_statuses};
}

void declare(cli::App& app, Options& options) {
  auto& motor = options.stage.motor;
  app.group("The table");
  app.option("--acceleration", "DEG/S2", motor.acceleration_deg_s2, {1, 10000}, "Of ramps and smooth stops.");
  app.option("--speed-error", "PART", motor.speed_error, {-0.5, 0.5}, "Relative: 0.01 turns 1 % too fast.");
  app.option("--ripple", "PART", motor.ripple, {0, 0.5},
             "Relative amplitude of a speed error that repeats every 30 degrees.");
  app.option("--max-speed", "DEG/S", options.stage.max_speed_deg_s, {1, 10000},
             "Faster commands are refused with error 8.");
  app.option("--min", "DEG", options.stage.min_deg, {-1e7, 0},
             "Lower limit; below it commands are refused with error 7.");
  app.option("--max", "DEG", options.stage.max_deg, {0, 1e7}, "Upper limit.");
  app.option("--at", "DEG", options.stage.home_deg, {-180, 180},
             "Where the table stands at power-on, from its reference.");
  app.group("The line");
  app.choice("--protocol", options.protocol, {"gcs", "grbl"},
             "A PI controller, or a GRBL 1.1 board with the table on X.");
  app.option("--latency", "MS", options.latency_ms, {0, 1000}, "From question to answer.");
  app.option("--jitter", "MS", options.jitter_ms, {0, 1000},
             "Random part more, before and after the controller looks at its axis.");
  app.option("--baud", "BAUD", options.baud, {50, 4000000}, "Understand nothing at any other rate.");
  app.option("--address", "N", options.stage.address, {1, 16}, "Of the controller in a daisy chain.");
  app.option("--fault", "FAULT", options.faults, "Something that goes wrong, as KIND@COMMAND[:N]; may be repeated.");
  app.group("The program");
  app.option("--seed", "N", options.seed, {0, 1e9}, "Of the random numbers.");
  app.option("--log", "FILE", options.log, "Append what happens, one JSON line an event.");
  app.option("--link", "FILE", options.link, "Make this symbolic link to the pseudo-terminal; removed at the end.");
  app.flag("--shim", options.shim, "Print the path of the library to preload, and end.");
  app.flag("--die-with-parent", options.with_parent, "End when the process that started this one ends.");
}

// Beside the program in a build tree (bin/../lib), or where it is installed.
std::string shim_path() {
  const auto prefix = std::filesystem::canonical("/proc/self/exe").parent_path().parent_path();
  for (const char* folder : {"lib/vam", VAM_LIBDIR "/vam"}) {
    const auto candidate = prefix / folder / "vam-pty-shim.so";
    if (std::filesystem::exists(candidate)) return candidate;
  }
  throw Error{Fault::no_input, "vam-pty-shim.so: not beside this program; install it again"};
}

class Link {
 public:
  Link(const std::string& path, const std::string& target) : path_(path) {
    if (path.empty()) return;
    std::error_code problem;
    if (std::filesystem::is_symlink(path)) std::filesystem::remove(path, problem);
    std::filesystem::create_symlink(target, path, problem);
    if (problem) throw Error{Fault::no_output, path + ": cannot make the link (" + problem.message() + ")"};
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

void run(Options& options) {
  if (options.shim) return device::print_line(shim_path());
  if (options.with_parent) device::end_with_parent();
  options.stage.latency_s = 1e-3 * options.latency_ms;
  options.stage.jitter_s = 1e-3 * options.jitter_ms;
  options.stage.seed = static_cast<std::uint64_t>(options.seed);
  for (const auto& fault : options.faults) options.stage.faults.push_back(sim::parse_sim_fault(fault));
  const auto make = options.protocol == "grbl" ? sim::make_sim_grbl : sim::make_sim_gcs;
  const auto stage = make(options.stage, device::real_clock().now_s(), sim::file_sim_log(options.log));
  sim::Pty pty;
  const Link link(options.link, pty.path());
  device::print_line(pty.path());
  device::hurry(device::Urgency::driver);  // a controller has nothing else to do
  sim::serve(pty, *stage, options.baud);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  cli::App app(manual());
  declare(app, options);
  return app.run(argc, argv, [&] { device::interruptible([&] { run(options); }); });
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string>

#include "base/error.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "cli/companion.hpp"
#include "device/os/clock.hpp"
#include "device/os/interrupt.hpp"
#include "vam-correct/renewal.hpp"

namespace vam::correct_tool {

namespace {

namespace fs = std::filesystem;

void declare(cli::App& app, RenewOptions& o) {
  app.positional(
      "RUN", o.run,
      "Run folder of vam-print, or one with flips.jsonl (the log of vam-project), printer.toml, sinogram.exr, "
      "and the volumes of vam-ost --live in ost, its log in ost.jsonl.");
  app.option("--target", "PART", o.target, "Volume of the part from which the sinogram was computed.").required();
  app.option("--curve", "RECORD", o.curve, "Record of vam-calibrate working-curve of this resin.").required();
  app.option("--iterations", "N", o.iterations, {1, 1e9}, "Iterations of vam-optimize.");
  app.option("--max-uncertainty", "PERCENT", o.max_uncertainty_percent, cli::positive,
             "Maximum uncertainty of the sensitivity (one standard deviation) anywhere in the part.");
  app.option("--axis-sigma", "PX", o.axis_sigma_px, cli::non_negative,
             "Standard deviation of projector.axis_column; above 0 the axis is found in the volumes, too.");
  app.option("--lead", "FRACTION", o.lead, cli::non_negative,
             "Fraction of a turn within which new projections are expected to be ready, until the first ones are.");
  app.option("--once", "N", o.once, {0, 1e9},
             "Take this volume only, ost/scatter-N.vdb, and exit with status 1 where there are no new projections.")
      .default_is("each volume that appears, until the print ends");
  app.option("--die-with", "PID", o.guard, {1, 1e9}, "Exit when this process has exited.");
}

// The number of the newest volume; -1: there is none.
int newest(const std::string& folder) {
  int most = -1;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename();
    int number = 0;
    if (std::sscanf(name.c_str(), "scatter-%d", &number) == 1 && name == scatter_name(number))
      most = std::max(most, number);
  }
  return most;
}

bool has_ended(const std::string& run) {
  constexpr std::streamoff tail_bytes = 4096;
  LogLines log(run + "/flips.jsonl", tail_bytes);
  for (Json line; log.next(line);) {
    if (text_at(line, "event") == "end") return true;
  }
  return false;
}

// Each volume that appears, until the print ends, or who waits for it.
void follow(const RenewOptions& o, Renewal& renewal) {
  constexpr double pause_s = 0.2;
  for (int done = -1;;) {
    if (const int number = newest(o.run + "/ost"); number > done) {
      done = number;
      (void)renewal.take(number);
    }
    if (has_ended(o.run) || (o.guard && kill(*o.guard, 0) != 0 && errno == ESRCH)) return;
    device::real_clock().sleep_until(device::real_clock().now_s() + pause_s);
  }
}

void run(const cli::App& /*app*/, RenewOptions& o) {
  if (o.run.starts_with('-')) o.run = "./" + o.run;
  cli::find_tools_beside();
  device::supervise();
  device::interruptible([&] {
    for (const std::string& file : {o.run + "/sinogram.exr", o.run + "/printer.toml", o.target, o.curve}) {
      if (!fs::is_regular_file(file)) throw Error{Fault::no_input, file + ": cannot open it"};
    }
    Renewal renewal(o);
    if (!o.once) return follow(o, renewal);
    const std::string volume = o.run + "/ost/" + scatter_name(*o.once);
    if (!fs::exists(volume)) throw Error{Fault::no_input, volume + ": cannot open it"};
    if (const std::string reason = renewal.take(*o.once); !reason.empty())
      throw Error{Fault::judged, "volume " + std::to_string(*o.once) + ": " + reason};
  });
}

}  // namespace

void add_renew(cli::App& app) {
  app.subcommand<RenewOptions>("renew", "compute new projections for a running print, once a turn", declare, run);
}

}  // namespace vam::correct_tool

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-correct/renew.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "cli/companion.hpp"
#include "io/exr/stack.hpp"
#include "io/settings/printer_file.hpp"
#include "session/exposure.hpp"

namespace vam::correct_tool {

namespace {

struct RenewOptions {
  std::string run, target, curve;
  int iterations = 12;
  double max_uncertainty_percent = 3;
  double axis_sigma_px = 0;
  double lead = 0.5;
  std::optional<int> once, guard;
};

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

/// Turns as planned, and their fraction of full intensity.
struct Plan {
  double turns = 0, multiplier = 0;
};

Plan plan_of(const std::string& run) {
  io::StackReader light(run + "/sinogram.exr");
  float peak = 0;
  Image image;
  for (model::ImageInfo about; light.next(image, about);) {
    for (const float value : image.values) peak = std::max(peak, value);
  }
  const auto printer = io::load_printer(run + "/printer.toml", {});
  const auto shown = session::exposure_of(run + "/sinogram.exr", light.info(), printer, static_cast<double>(peak));
  if (shown.share) return {shown.turns, static_cast<double>(peak) / shown.full_scale};
  throw Error{Fault::data, run +
                               "/sinogram.exr: has no planned exposure; compute it by vam-optimize for a printer "
                               "with resin.critical_dose_mj_cm3"};
}

void run(const cli::App& /*app*/, RenewOptions& o) {
  const auto text = [](const std::optional<int>& number) { return number ? std::to_string(*number) : ""; };
  const Plan plan = plan_of(o.run);
  cli::become_companion("renew",
                        {o.run, o.target, o.curve, format_number(plan.turns, 9), format_number(plan.multiplier, 9),
                         std::to_string(o.iterations), format_number(o.max_uncertainty_percent, 9),
                         format_number(o.axis_sigma_px, 9), format_number(o.lead, 9), text(o.once), text(o.guard)});
}

}  // namespace

void add_renew(cli::App& app) {
  app.subcommand<RenewOptions>("renew", "compute new projections for a running print, once a turn", declare, run);
}

}  // namespace vam::correct_tool

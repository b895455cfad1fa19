// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-print/options.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "base/text/text.hpp"
#include "device/open/open.hpp"
#include "model/device_schemes.hpp"

namespace vam::print_tool {

namespace {

constexpr const char* until_flag = "--until";
constexpr const char* view_flag = "--view-step";

void add_instrument(cli::App& app, Options& o) {
  app.option("--display", "DEVICE", o.display, "Display for the frames: drm:HDMI-A-1, sdl:0, or null: for a dry run.")
      .required();
  app.option("--light", "DEVICE", o.light, "Light engine: " + model::forms_of(model::light_schemes) + ".");
}

void add_motion(cli::App& app, Options& o) {
  app.option("--turns", "N", o.turns, {1, 100000}, "Turns of the print.")
      .default_is("as planned for the resin, else stage.turns")
      .excludes({"--resume"});
  app.option("--run-up", "TURNS", o.run_up_turns, {0, 100}, "Dark turns at full speed before the print.");
  app.flag("--home", o.home, "Find the reference of the stage first.");
  app.option("--frames-per-turn", "N", o.frames_per_turn, {1, 1000000}, "Frames to preload.")
      .default_is("one for each angle of the sinogram");
  app.option("--max-missed", "FRACTION", o.max_missed, {0, 1},
             "Maximum fraction of missed vertical blanks in the run-up.");
  app.option("--max-missed-lit", "FRACTION", o.max_missed_lit, {0, 1},
             "Maximum fraction of missed vertical blanks by the end of the print, at least that of --max-missed. A "
             "frame that stays on for one period too long is logged; the next frame shown is that of its own angle.");
}

void add_acceptance(cli::App& app, Options& o) {
  app.option("--need", "SCANS", o.need, "Required calibration records, separated by commas.");
  app.flag("--uncalibrated", o.uncalibrated, "Use only the printer file, without calibration records.");
  app.flag("--accept-printer", o.accept_printer,
           "Accept a sinogram that was computed for another printer, with a warning that names the differences; they "
           "are also in the report (printer_differences).");
  app.flag("--accept-dose", o.accept_dose,
           "Print less than 0.9 or more than 1.1 of the dose that was planned for the resin, with a warning.");
}

void add_views(cli::App& app, Options& o) {
  app.option(view_flag, "DEG", o.view_step_deg, cli::positive, "Capture camera views, this angle apart.");
  app.option("--dark-turns", "N", o.dark_turns, {0, 99999},
             "Turns after the light, with views, in which the resin still scatters; for vam-calibrate working-curve.")
      .only_with({view_flag})
      .excludes({until_flag});
  app.option(until_flag, "CONDITIONS", o.until,
             "Stop when these conditions of vam-ost hold; requires views at most 12 degrees apart, at least 2 turns, "
             "--target, and --isovalue or --resin. These options are checked before anything moves, and by --plan.")
      .default_is("after the last turn")
      .only_with({view_flag});
  app.option("--target", "FILE", o.target, "Option of vam-ost for --until.");
  app.option("--isovalue", "VALUE", o.isovalue, "Option of vam-ost for --until.");
  app.option("--resin", "FILE", o.resin, "Option of vam-ost for --until.");
}

void add_correction(cli::App& app, Options& o) {
  app.flag("--correct", o.correct,
           "Compute new projections once a turn from what the views show of the resin: vam-correct renew follows the "
           "run folder, niced and with at most half of the memory, and puts them into renewed/, from where vam-project "
           "--frames-from shows them. --resin is a "
           "record of vam-calibrate working-curve. --turns is then the maximum, more than the turns of the plan, which "
           "are determined before anything moves (plan.json). New projections state for how many turns they are "
           "shown; the print ends with them. In doubt, and if vam-correct renew fails, the print continues unchanged "
           "until --until; a print that was never corrected is reported, with the last reason. If the camera or "
           "vam-ost is lost, it ends at the turn of its plan, or as it was corrected, with status 1.")
      .only_with({until_flag})
      .only_with({"--resin"})
      .excludes({"--resume"});
  app.option("--axis-sigma", "PX", o.axis_sigma_px, cli::non_negative,
             "Standard deviation of projector.axis_column; above 0 the axis is found in the views, too.")
      .only_with({"--correct"});
}

void add_run(cli::App& app, Options& o) {
  app.option("--run", "DIR", o.run,
             "Run folder, which must not exist. A print that is refused before anything moves or is lit leaves no "
             "folder.")
      .default_is("print-UTC, then print-UTC-2 and so on, if several prints begin in the same second");
  app.option(
      "--resume", "RUN", o.resume,
      "Resume the aborted print whose run folder is RUN, also one aborted by a power failure, and deliver the "
      "remaining exposure to the same vial: from the angle after its last image to its last turn, with its own "
      "settings (--printer replaces them), including the calibration: current records are neither required nor "
      "applied. The sinogram, the stage and the camera must be the same, and the reference of the stage must not have "
      "changed. Logs, records or settings that were changed since are refused, as are flips that were lost, "
      "changed or cannot be: what they do not state would be exposed twice. Restore flips.jsonl; light of the last "
      "second before a power failure may be missing in it. Settings that determine the dose or its position "
      "(projector, vial, bath, resin, speed and direction of the stage) and differ from those of the print are "
      "refused by name, unless --accept-printer is given. A print can be resumed once: its folder then contains "
      "resumed.json, which names the continuation; if that is aborted, too, it is the one to resume. A copy of the "
      "folder that was made before the resumption holds no trace of it: never resume a copy. Given with the folder "
      "of the resumption, vam-check k1 rest finds it. vam-dose --shown RUN computes the dose that a print, or a "
      "print and its resumptions, delivered.");
  app.flag("--run-page", o.page,
           "Write page.html into the run folder: a page for a browser that refreshes itself during the print "
           "(vam-status).");
  app.flag("--plan", o.plan,
           "Check the print and print its plan: the records and their ages; frames, memory, duration, maximum "
           "intensity, and the dose in relation to resin.critical_dose_mj_cm3 (if the sinogram states its threshold, "
           "as those of vam-optimize do); the identity of each device; the travel and the limits of the stage. Nothing "
           "moves, no light is switched on, no folder is created. Problems are reported on standard error, and the "
           "rest is printed nevertheless; the exit status is that of the first error.");
  app.flag("--commands", o.commands,
           "Print also the command lines of the print, which run by hand; nobody watches over them then.")
      .only_with({"--plan"});
}

}  // namespace

void declare(cli::App& app, Options& options) {
  app.positional("SINOGRAM", options.sinogram, "Projector sinogram of vam-optimize or vam-resample.").reads();
  add_instrument(app, options);
  add_motion(app, options);
  add_acceptance(app, options);
  add_views(app, options);
  add_correction(app, options);
  add_run(app, options);
  cli::add_printer(app, options.printer);
  app.usual({"--display", "--light", "--printer", "--set", "--turns", "--home", "--need", "--uncalibrated",
             "--accept-printer", "--accept-dose", "--view-step", "--until", "--correct", "--run", "--resume",
             "--run-page", "--plan"});
}

void require_sound(const Options& options) {
  if (!device::names_display(options.display)) {
    throw Error{Fault::usage,
                "--display: '" + options.display + "' is not one of " + model::forms_of(model::display_schemes)};
  }
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(options.sinogram, ignored))
    throw Error{Fault::no_input, options.sinogram + ": cannot open it"};
  constexpr double most_view_step_deg = 12;
  if (!options.until.empty() && *options.view_step_deg > most_view_step_deg) {
    throw Error{Fault::usage, std::string(view_flag) + ": is " + format_number(*options.view_step_deg) +
                                  "; --until requires views at most 12 degrees apart"};
  }
}

std::vector<std::string> needed_scans(const Options& options) {
  std::vector<std::string> scans;
  if (options.uncalibrated) return scans;
  for (const std::string& part : split(options.need, ',')) {
    for (const std::string& scan : split(part, ' ')) {
      if (!scan.empty()) scans.push_back(scan);
    }
  }
  return scans;
}

}  // namespace vam::print_tool

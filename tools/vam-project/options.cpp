// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/options.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>

#include "base/error.hpp"
#include "device/open/open.hpp"
#include "io/stream/stream.hpp"
#include "model/device_schemes.hpp"
#include "session/printer.hpp"

namespace vam::project {

namespace {

void add_time(cli::App& app, Options& options) {
  app.group("Time");
  app.option("--fps", "HZ", options.fps, cli::rate, "Frames per second.")
      .default_is("projector.fps; for slices print speed / slice height")
      .excludes({"--print-speed"});
  app.option("--print-speed", "MM_H", options.print_speed_mm_h, cli::rate, "Speed of the platform, for slices.")
      .default_is("as stated in the stack")
      .not_for({"sinograms"});
  app.option("--speed", "DEG/S", options.speed_deg_s, cli::rate, "Stage speed.")
      .default_is("stage.speed_deg_s")
      .not_for({"slices"});
  app.option("--turns", "N", options.turns, cli::positive, "Turns of the print; not necessarily a whole number.")
      .default_is("as planned for the resin, else stage.turns")
      .not_for({"slices"});
}

void add_position(cli::App& app, Options& options) {
  app.group("Position");
  app.choice("--orientation", options.orientation, {"normal", "flip-columns", "flip-rows", "rotate-180"},
             "Mounting of the projector.")
      .default_is("projector.orientation");
  app.option(
      "--column-offset", "PX", options.column_offset, {-65536, 65536},
      "Distance in columns from projector.axis_column to the image of the axis, positive to the right; the light is "
      "shifted by it.");
  app.option("--row-offset", "PX", options.row_offset, {-65536, 65536},
             "Distance in rows from projector.axis_row to the image of z = 0, positive downwards; the light is shifted "
             "by it.");
  app.option("--flatland", "MM", options.flatland_mm, cli::any, "Show the slice nearest to this z from above.")
      .not_for({"slices"});
}

void add_grey(cli::App& app, Options& options) {
  app.group("Grey");
  app.option("--bits", "N", options.bits, {1, 16}, "Bits per pixel: 1, 2, 4, 8, 10 or 16.")
      .default_is("projector.bits");
  app.option("--full-scale", "VALUE", options.full_scale, cli::positive, "Sinogram value shown at full intensity.")
      .default_is("as planned for the resin, else the maximum of the stack, for slices 1");
  app.option("--multiplier", "FACTOR", options.multiplier, cli::positive,
             "Factor on the intensity; values above full intensity are clipped.");
  app.option(
      "--dither", "N", options.dither_turns, {1, 1000},
      "Round by error diffusion over columns and angles, so that the dose, a sum over many pixels, is accurate to less "
      "than a grey level. The frames of N turns differ: in them a pixel between two levels shows both in proportion. N "
      "must divide the number of turns.");
  app.not_for({"slices", "stacks without --bits"});
}

void add_live(cli::App& app, Options& all) {
  LiveOptions& options = all.live;
  const std::string heading = "Live output";
  app.group(heading, {}, {"files", "slices"});
  app.option("--follow", "FILE", options.follow,
             "Read the stage angle from this output of vam-stage spin, a FIFO or - (SINOGRAM is then required).")
      .reads();
  app.option("--frames-per-turn", "N", options.frames_per_turn, {1, 1000000}, "Frames to preload.")
      .default_is("one for each angle of the sinogram");
  app.option("--from", "DEG", options.from_deg, {0, 1e9},
             "Stay dark until this stage angle, to print the rest of an aborted print.");
  app.option("--latency", "MS", options.latency_ms, {-1000, 1000},
             "Delay of the projector, from the vertical blank to the light.")
      .default_is("projector.latency_ms");
  app.option("--max-missed", "FRACTION", options.allowed_missed, {0, 1},
             "Maximum fraction of missed vertical blanks in the run-up.");
  app.option("--max-missed-lit", "FRACTION", options.allowed_missed_lit, {0, 1},
             "Maximum fraction of missed vertical blanks by the end of the print, at least that of --max-missed.");
  app.option(
      "--frames-from", "FOLDER", options.frames_from,
      "Look for new projections in this folder while printing: a sinogram (EXR) that appears in it takes the place "
      "of the one that is shown, from the next turn on, without a dark image. It must have the same columns, "
      "angles and poses and be for the same printer; one that is not is reported in the log, and the frames "
      "stay, as they do while new ones are late. A sinogram that states its full scale, as those of vam-optimize "
      "--turns do, is shown at it, another one at that of the first; what exceeds that is clipped and counted in the "
      "log. A file named turn-N.exr is for turn N only, and refused once that has begun. Names that begin with a dot "
      "are passed over.");
  app.flag("--plan", all.only_plan,
           "Print frames, memory, duration and dose, query display and light engine for their identity, and show "
           "nothing; with --pattern only the query.")
      .excludes({"--report"});
  app.group(heading, {}, {"files"});
  app.option("--light", "DEVICE", options.light, "Light engine: " + model::forms_of(model::light_schemes) + ".");
  app.option("--log", "FILE", options.log,
             "Append one JSON line per event, with UTC and monotonic time: every flip with frame and angle, and the "
             "reason of the end; - is standard error. Every second it is brought to the disk.");
  app.flag("--die-with-parent", options.with_parent, "Blank the display and exit when the parent process exits.");
}

void add_patterns(cli::App& app, PatternOptions& options) {
  options.plan.name.clear();
  app.group("Test patterns (instead of a sinogram)");
  app.option(
         "--pattern", "NAME", options.plan.name,
         "Test pattern: star (focus), axis, grid, grey, ramp (uniform levels from 0 to full), sweep (a line across the "
         "columns), row (a line at z = 0, for vam-calibrate beam) or blink (black and level in a pseudo-random "
         "sequence "
         "of 127 steps, for vam-calibrate latency; give --hold 0.02).")
      .form()
      .excludes(
          {"--fps",         "--turns",    "--speed",         "--print-speed",    "--full-scale",  "--multiplier",
           "--dither",      "--flatland", "--column-offset", "--row-offset",     "--follow",      "--frames-per-turn",
           "--from",        "--latency",  "--max-missed",    "--max-missed-lit", "--frames-from", "--accept-printer",
           "--accept-dose", "--freeze",   "--report"});
  app.option("--grey", "FRACTION", options.plan.level, {0, 1},
             "Grey level of lines and fields, as a fraction of full grey.")
      .only_with({"--pattern"})
      .excludes({"--pattern ramp"});
  app.option("--pitch", "PX", options.pitch_px, {1, 100000}, "Pitch of grid lines, and step of the sweep.")
      .default_is("16; 4 for sweep")
      .only_with({"--pattern grid", "--pattern sweep"});
  app.option("--width", "PX", options.width_px, {1, 100000}, "Width of lines.")
      .default_is("1; 4 for sweep")
      .only_with({"--pattern axis", "--pattern grid", "--pattern sweep", "--pattern row"});
  app.option("--steps", "N", options.plan.steps, {2, 65536}, "Levels of the ramp.").only_with({"--pattern ramp"});
  app.option("--hold", "S", options.hold_s, {0.001, 86400}, "Duration of each frame.").only_with({"--pattern"});
  app.flag("--repeat", options.repeat, "Repeat from the first frame, until a signal.")
      .only_with({"--pattern"})
      .not_for({"files"});
}

}  // namespace

void declare(cli::App& app, Options& options) {
  app.positional("SINOGRAM", options.input,
                 "Sinogram stack (EXR) for the projector, with --flatland a virtual one; or the slices of "
                 "vam-curethrough, a frame stack (EXR) or a folder of images.")
      .reads({"--pattern"});
  cli::add_output(app, options.output);
  add_time(app, options);
  add_position(app, options);
  add_grey(app, options);
  add_live(app, options);
  add_patterns(app, options.pattern);
  cli::add_printer(app, options.printer);
  app.flag("--accept-printer", options.accept_printer,
           "Accept a sinogram that was computed for another printer, with a warning that names the differences.");
  app.flag("--accept-dose", options.accept_dose,
           "Show less than 0.9 or more than 1.1 of the dose that was planned for the resin, with a warning.")
      .not_for({"slices"});
  app.option("--freeze", "FILE", options.freeze,
             "Check the sinogram against the printer, write the settings in force to FILE, including calibration "
             "records, planned turns and with absolute paths, and exit; used by vam-print.");
  app.group("Stack", {}, {"displays", "folders", "videos"});
  cli::add_stack_output(app, options.stack.half, options.stack.compression);
  app.group("Output and performance");
  cli::add_report(app, options.report);
  cli::add_threads(app);
  app.usual({"--output", "--accept-printer", "--fps", "--speed", "--turns", "--orientation", "--multiplier", "--dither",
             "--follow", "--light", "--log", "--pattern", "--printer", "--set", "--report"});
}

namespace {

/// "nul:" or "drn:HDMI-A-1", but not "2026-11-25T15:00.mkv".
void refuse_unknown_display(const std::string& output) {
  const auto colon = output.find(':');
  const bool scheme = colon != std::string::npos && std::isalpha(static_cast<unsigned char>(output.front())) != 0 &&
                      std::all_of(output.begin(), output.begin() + static_cast<std::ptrdiff_t>(colon),
                                  [](unsigned char c) { return std::isalnum(c) != 0; });
  const bool file =
      output.ends_with('/') || output.ends_with(".mkv") || output.ends_with(".mp4") || output.ends_with(".exr");
  if (!scheme || file) return;
  throw Error{Fault::usage, output + ": '" + output.substr(0, colon) + "' is no kind of display; give -o " +
                                model::forms_of(model::display_schemes) + ", or ./" + output + " for files"};
}

}  // namespace

bool is_live(const cli::App& app, const std::string& output) {
  const bool live = device::names_display(output);
  if (!live) refuse_unknown_display(output);
  const std::array files{"folders", app.given("--bits") ? "stacks" : "stacks without --bits", "videos"};
  app.require_for(live ? "displays" : files.at(static_cast<std::size_t>(io::frame_output(output))), output);
  if (!live) app.require_for("files", output == "-" ? "standard output" : output);
  return live;
}

model::Printer settle(Options& options, const model::Metadata& facts) {
  optics::set_lines(options.pattern.plan, options.pattern.pitch_px, options.pattern.width_px);
  model::Printer printer =
      session::printer_of(options.printer, facts, io::input_name(options.input), session::Role::instrument);
  printer.projector.fps = options.fps.value_or(printer.projector.fps);
  printer.projector.bits = options.bits.value_or(printer.projector.bits);
  printer.stage.speed_deg_s = options.speed_deg_s.value_or(printer.stage.speed_deg_s);
  if (!options.orientation.empty()) printer.projector.orientation = options.orientation;
  const int bits = printer.projector.bits;
  if (bits != 1 && bits != 2 && bits != 4 && bits != 8 && bits != 10 && bits != 16) {
    throw Error{Fault::usage, "--bits: " + std::to_string(bits) + " is not one of 1, 2, 4, 8, 10, 16"};
  }
  options.live.max_led_current_percent = printer.projector.max_led_current_percent;
  options.live.relay = printer.projector.relay;
  if (!options.live.latency_ms) options.live.latency_ms = printer.projector.latency_ms;
  return printer;
}

}  // namespace vam::project

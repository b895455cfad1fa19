// SPDX-License-Identifier: GPL-3.0-or-later
// vam-project: projector frames from sinograms, for files or a screen; one frame per time step of the turning stage.
#include <optional>
#include <span>
#include <vector>

#include "base/index.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "cli/app.hpp"
#include "device/open/open.hpp"
#include "device/os/interrupt.hpp"
#include "io/exr/stack.hpp"
#include "io/image/frame_sink.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "manual_page.hpp"
#include "model/metadata.hpp"
#include "model/printer.hpp"
#include "model/rows.hpp"
#include "optics/patterns.hpp"
#include "optics/projector_frames.hpp"
#include "resin/absolute_dose.hpp"
#include "session/exposure.hpp"
#include "session/printer.hpp"
#include "vam-project/live.hpp"
#include "vam-project/match.hpp"
#include "vam-project/options.hpp"
#include "vam-project/plan.hpp"
#include "vam-project/print.hpp"
#include "vam-project/show.hpp"
#include "vam-project/slices.hpp"
#include "vam-project/turn.hpp"

namespace vam::project {

namespace {

// Columns and rows as the projector is mounted.
GreyImage oriented_pattern(const PatternOptions& options, const model::Projector& projector, int n) {
  const GreyImage plain = optics::pattern_frame(options.plan, projector, n);
  Image levels(plain.width, plain.height);
  for (std::size_t i = 0; i < plain.values.size(); ++i) levels.values[i] = plain.values[i];
  optics::orient(levels, projector.orientation);
  GreyImage turned(levels.width, levels.height, plain.bits);
  for (std::size_t i = 0; i < levels.values.size(); ++i)
    turned.values[i] = static_cast<std::uint16_t>(levels.values[i]);
  return turned;
}

io::ProjectorFrame pattern_as_frame(const GreyImage& levels, double time_s) {
  io::ProjectorFrame frame;
  frame.levels = levels;
  frame.intensity = Image(levels.width, levels.height);
  for (std::size_t i = 0; i < levels.values.size(); ++i) {
    frame.intensity.values[i] = static_cast<float>(levels.values[i]) / static_cast<float>(levels.full());
  }
  frame.time_s = time_s;
  return frame;
}

// For readers of the log: the frames that flips refer to.
Json facts(const optics::PatternPlan& plan) {
  return {{"name", plan.name},
          {"level", plan.level},
          {"pitch_px", plan.pitch_px},
          {"width_px", plan.width_px},
          {"steps", plan.steps}};
}

model::StackInfo stack_info(const model::Projector& projector, int count) {
  model::StackInfo info;
  info.kind = model::Kind::frames;
  info.space = model::Space::projector;
  info.width = projector.columns;
  info.height = projector.rows;
  info.count = count;
  info.pixel_mm = projector.pixel_mm;
  info.row_mm = -projector.pixel_mm;
  info.z_start_mm = model::z_mm(projector, 0);
  info.units = "fraction of full grey";
  return info;
}

void show_pattern(const cli::App& app, const Options& options, const model::Projector& projector) {
  const PatternOptions& pattern = options.pattern;
  const std::vector<int> order = optics::pattern_order(pattern.plan, projector);
  if (device::names_display(options.output)) {
    const auto play = [&] {
      Live live(options.live, options.output, {projector.columns, projector.rows, 60});
      const int count = optics::pattern_frames(pattern.plan, projector);
      for (int n = 0; n < count; ++n) live.add(oriented_pattern(pattern, projector, n));
      live.note("pattern", facts(pattern.plan));
      live.play_through(pattern.hold_s, pattern.repeat, order);
    };
    return device::interruptible([&] { device::logged(options.live.log, play); });
  }
  model::StackInfo info = stack_info(projector, count_of(order));
  info.history.push_back(app.history());
  const auto sink = io::open_frame_sink(options.output, {info, 1 / pattern.hold_s, projector.bits, options.stack});
  for (int n = 0; const int shown : order) {
    const io::ProjectorFrame frame =
        pattern_as_frame(oriented_pattern(pattern, projector, shown), n++ * pattern.hold_s);
    sink->write(std::span(&frame, 1));
  }
  sink->commit();
}

/// A frame for every frame period of the projector while the stage turns.
void write_turns(const cli::App& app, const Options& options, const model::Printer& printer, io::StackReader& reader) {
  app.require_for("sinograms", io::input_name(options.input));
  const model::Projector& projector = printer.projector;
  const auto differences = require_printer(options, reader.info(), printer);
  const Light light = read_light(options, reader, projector);
  const session::Exposure exposure = exposure_of(options, reader.info(), light, printer);
  const double turns = exposure.turns;
  const auto schedule = optics::frame_schedule(projector.fps, printer.stage.speed_deg_s, turns);

  tell_width(options.input, reader.info(), schedule.step_deg);
  const auto place = optics::frame_place(projector, options.column_offset, options.row_offset);
  io::FrameSinkOptions facts{optics::frames_info(reader.info(), place, schedule, projector.orientation), projector.fps,
                             projector.bits, options.stack};
  facts.info.units = "fraction of full intensity";
  model::Printer shown = printer;  // with the axis where the frames have it
  shown.projector.axis_column += options.column_offset;
  shown.projector.axis_row += options.row_offset;
  facts.info.extra["vam:printer"] = io::printer_settings(shown);
  facts.info.extra["vam:fps"] = format_number(projector.fps, 9);
  if (exposure.share) {  // of fractions of full intensity
    session::state_exposure(facts.info.extra, turns, 1);
    if (const auto threshold = model::threshold_dose(facts.info.extra))
      facts.info.extra["vam:threshold_dose"] = format_number(*threshold / exposure.full_scale, 9);
  }
  facts.info.history.push_back(app.history());
  const auto sink = io::open_frame_sink(options.output, facts);
  const Dithering dithering = dithering_of(options, 360 / schedule.step_deg, turns);
  const Frames frames = frames_of(light, schedule, dithering);
  const auto tally =
      show(frames, static_cast<float>(1 / exposure.full_scale), projector, app.given("--bits"), dithering, *sink);
  Json report = figures(frames, projector.bits, exposure.full_scale * options.multiplier, tally);
  if (exposure.share) report["share_of_planned_dose"] = *exposure.share;
  if (!differences.empty()) report["printer_differences"] = differences;
  io::write_report(options.report, "vam-project", report);
}

/// Each slice once.
void write_slices(const cli::App& app, const Options& options, const model::Printer& printer,
                  const SliceStack& slices) {
  const Frames frames = slices_in_time(app, options, printer, slices);
  io::FrameSinkOptions facts{facts_of(slices, frames.fps, printer.projector), frames.fps, printer.projector.bits,
                             options.stack};
  facts.info.history.push_back(app.history());
  const auto sink = io::open_frame_sink(options.output, facts);
  const auto scale = static_cast<float>(options.multiplier / options.full_scale.value_or(1));
  const auto tally = show(frames, scale, printer.projector, app.given("--bits"), {}, *sink);
  io::write_report(options.report, "vam-project", slice_figures(frames, options, printer.projector, tally));
}

}  // namespace

}  // namespace vam::project

namespace {

using namespace vam;
using project::Options;

void freeze(const Options& options, model::Printer printer, io::StackReader& reader) {
  project::require_whole(options.input, reader.info());
  require_printer(options, reader.info(), printer);
  if (reader.info().kind == model::Kind::sinogram) {
    const std::string name = io::input_name(options.input);
    const session::GivenExposure given{.sets = options.printer.sets};
    session::Exposure shown = session::exposure_of(name, reader.info(), printer, 0, given);
    if (!shown.share && resin::dose_per_radian_mj_cm3(printer)) {
      const double peak = read_light(options, reader, printer.projector).peak;
      shown = session::exposure_of(name, reader.info(), printer, peak, given);
    }
    session::warn_of_turns(shown, name);
    if (shown.share) printer.stage.turns = ceil_int(shown.turns);
  }
  io::write_text(options.freeze, io::printer_toml(io::frozen(printer)));
}

/// Whether the input is a stack: neither a test pattern nor a folder of images, nor without need on a pipe.
bool takes_stack(const cli::App& app, const Options& options) {
  const bool folder = project::is_folder(options.input);
  if (folder && options.only_plan) app.require_for("slices", options.input);
  const bool needless = options.printer.print && options.input == "-";
  return options.pattern.plan.name.empty() && !needless && (!folder || !options.freeze.empty());
}

void run(const cli::App& app, Options& options) {
  const bool live = options.freeze.empty() && !options.printer.print && project::is_live(app, options.output);
  std::optional<io::StackReader> stack;
  if (takes_stack(app, options)) stack.emplace(options.input);
  const bool turns = stack && stack->info().kind == model::Kind::sinogram;
  const model::Printer printer = settle(options, turns ? stack->info().extra : model::Metadata{});
  if (session::print_printer(options.printer, printer, options.output)) return;
  if (!options.freeze.empty()) return freeze(options, printer, *stack);
  if (!options.pattern.plan.name.empty()) {
    if (options.only_plan) return project::print_devices(options, printer);
    return project::show_pattern(app, options, printer.projector);
  }
  if (options.only_plan) return print_plan(app, options, printer, *stack);
  if (live) return device::interruptible([&] { print_live(app, options, printer, stack ? &*stack : nullptr); });
  if (turns) return project::write_turns(app, options, printer, *stack);
  project::write_slices(app, options, printer,
                        stack ? project::slices_of(options.input, *stack) : project::slice_folder(options.input));
}

}  // namespace

int main(int argc, char** argv) {
  cli::App app(
      {"vam-project", "convert sinograms into projector frames and show them", manual_page, cli::device_statuses});
  Options options;
  declare(app, options);
  return app.run(argc, argv, [&] { run(app, options); });
}

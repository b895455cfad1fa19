// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/print.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "optics/projector_frames.hpp"
#include "vam-project/live.hpp"
#include "vam-project/match.hpp"
#include "vam-project/renewal.hpp"
#include "vam-project/slices.hpp"

namespace vam::project {

namespace {

void write_report(const Options& options, Json& report, const device::PlayTally& shown) {
  report["flips"] = shown.flips;
  report["lit_flips"] = shown.lit;
  report["missed_flips"] = shown.missed;
  io::write_report(options.report, "vam-project", report);
}

void play_slices(const cli::App& app, const Options& options, const model::Printer& printer, const SliceStack& slices,
                 Live& live) {
  const Frames frames = slices_in_time(app, options, printer, slices);
  LiveSink sink(live, [&] { return live.play_through(1 / frames.fps, false); });
  const auto scale = static_cast<float>(options.multiplier / options.full_scale.value_or(1));
  const auto tally = show(frames, scale, printer.projector, app.given("--bits"), {}, sink);
  Json report = slice_figures(frames, options, printer.projector, tally);
  write_report(options, report, sink.tally);
}

// A screen shows one turn's frames again and again, and nothing here lifts the vial.
void require_repeating_poses(const Options& options, const model::StackInfo& info, double turns) {
  if (info.poses.empty() ||
      (std::abs(optics::turns_of(info) - 1) < 1e-6 && (turns == 1 || model::repeat(info.poses)))) {
    return;
  }
  throw Error{Fault::usage, options.input + ": a live print repeats one turn, which its poses do not allow; " +
                                "write the frames to a file (-o FILE.mkv) for the machine that moves the vial, or give "
                                "--turns 1 to show a single turn"};
}

std::string size_text(const model::StackInfo& info) {
  return std::to_string(info.width) + " columns x " + std::to_string(info.height) + " angles from " +
         format_number(info.angle_start_deg) + " deg in steps of " + format_number(info.angle_step_deg) + " deg, " +
         std::to_string(info.poses.size()) + " poses";
}

/// The light of a sinogram that is to take the place of another. Throws Fault::data unless it has the same columns,
/// angles and poses and is for the same printer.
Light read_renewed(const std::string& path, Options options, io::StackReader& reader, const model::StackInfo& shown,
                   const model::Printer& printer) {
  options.input = path;
  const model::StackInfo& info = reader.info();
  if (info.width != shown.width || info.height != shown.height || info.angle_start_deg != shown.angle_start_deg ||
      info.angle_step_deg != shown.angle_step_deg || info.poses != shown.poses) {
    throw Error{Fault::data, path + ": has " + size_text(info) + ", but the print shows " + size_text(shown) +
                                 "; compute it with the same options"};
  }
  (void)require_printer(options, info, printer);
  return read_light(options, reader, printer.projector);
}

/// What vam-dose --shown needs to know of a sinogram, `full_scale` its value at full intensity.
Json facts_of(const std::string& path, const std::string& sha256, double full_scale) {
  Json facts{{"sinogram", io::input_name(path)}, {"full_scale", full_scale}};
  if (!sha256.empty()) facts["sinogram_sha256"] = sha256;
  return facts;
}

/// The turn N at which a sinogram turn-N.exr must be taken; 0 for other names.
int turn_named(const std::string& path) {
  const std::string stem = std::filesystem::path(path).stem().string();
  constexpr std::string_view named = "turn-";
  if (!stem.starts_with(named)) return 0;
  const auto turn = parse_number(stem.substr(named.size()));
  constexpr double most = 1e6;
  return turn && *turn > 0 && *turn <= most ? round_int(*turn) : 0;
}

std::string hash_of(const std::string& path) { return path == "-" ? "" : io::sha256_of(path); }

// One turn's frames, or those of the turns that differ, into the display, then the print: the angle of the stage
// chooses the frame.
void play_turns(const cli::App& app, const Options& options, const model::Printer& printer, io::StackReader& reader,
                Live& live) {
  app.require_for("sinograms", io::input_name(options.input));
  const auto differences = require_printer(options, reader.info(), printer);
  const Light light = read_light(options, reader, printer.projector);
  const session::Exposure exposure = whole_exposure(options, reader.info(), light, printer);
  const int turns = round_int(exposure.turns);
  const int frames = options.live.frames_per_turn.value_or(reader.info().height);
  const Dithering dithering = dithering_of(options, frames, turns);
  const auto schedule = optics::frame_schedule(frames, 360, std::max(1, dithering.turns));
  tell_width(options.input, reader.info(), schedule.step_deg);
  const double full_scale = exposure.full_scale;
  const auto scale = static_cast<float>(1 / full_scale);
  const auto renew = [&](const std::string& path, const std::atomic<bool>& ended) {
    const std::string hash = hash_of(path);
    io::StackReader its(path);
    const Light renewed = read_renewed(path, options, its, reader.info(), printer);
    if (hash_of(path) != hash) throw Error{Fault::data, path + ": was changed while it was read; rename whole files"};
    ScreenSink screen(live.mode(), ended);
    const auto stated = session::exposure_of(path, its.info(), printer, 0, {.multiplier = options.multiplier});
    const double its_full = stated.full_scale > 0 ? stated.full_scale : full_scale;
    const auto seen = show(frames_of(renewed, schedule, dithering), static_cast<float>(1 / its_full), printer.projector,
                           false, dithering, screen);
    Json facts = facts_of(path, hash, its_full);
    facts["clipped"] = seen.clipped;
    const int its_turns = stated.planned ? ceil_int(stated.turns) : 0;
    if (its_turns > 0) facts["turns"] = its_turns;
    live.offer({std::move(screen.bytes), facts, turn_named(path), its_turns});
  };
  LiveSink sink(live, [&] {
    Json facts = facts_of(options.input, hash_of(options.input), full_scale);
    facts["frames"] = live.frames();
    facts["turns"] = turns;
    facts["from_deg"] = options.live.from_deg;
    live.note("sinogram", facts);
    std::optional<Renewal> renewal;  // its thread begins before the print hurries
    if (!options.live.frames_from.empty()) renewal.emplace(options.live.frames_from, live, renew);
    return live.play(frames, printer.stage.speed_deg_s, turns);
  });
  const Frames shown = frames_of(light, schedule, dithering);
  const auto tally = show(shown, scale, printer.projector, app.given("--bits"), dithering, sink);
  Json report = figures(shown, printer.projector.bits, full_scale * options.multiplier, tally);
  const double lit = 1 - options.live.from_deg / (360 * turns);
  if (exposure.share) report["share_of_planned_dose"] = *exposure.share * lit;
  report["duration_s"] = 360 * turns / printer.stage.speed_deg_s;
  if (!differences.empty()) report["printer_differences"] = differences;
  report.erase("fps");
  write_report(options, report, sink.tally);
}

}  // namespace

session::Exposure whole_exposure(const Options& options, const model::StackInfo& info, const Light& light,
                                 const model::Printer& printer) {
  require_repeating_poses(options, info, options.turns.value_or(optics::turns_of(info)));
  const session::Exposure exposure = exposure_of(options, info, light, printer);
  const double turns = exposure.turns;
  if (turns != std::floor(turns)) {
    throw Error{Fault::usage, "--turns: " + format_number(turns) + " is not a whole number, as a live print requires"};
  }
  if (options.live.from_deg >= 360 * turns) {
    throw Error{Fault::usage, "--from: " + format_number(options.live.from_deg) + " degrees is beyond the " +
                                  format_number(turns) + " turns of the print; give a smaller angle"};
  }
  return exposure;
}

void print_live(const cli::App& app, const Options& options, const model::Printer& printer, io::StackReader* stack) {
  device::logged(options.live.log, [&] {
    Live live(options.live, options.output, {printer.projector.columns, printer.projector.rows, 60});
    if (stack != nullptr && stack->info().kind == model::Kind::sinogram)
      return play_turns(app, options, printer, *stack, live);
    play_slices(app, options, printer,
                stack != nullptr ? slices_of(options.input, *stack) : slice_folder(options.input), live);
  });
}

}  // namespace vam::project

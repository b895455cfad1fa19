// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/files.hpp"

#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "io/image/frame_sink.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"
#include "model/metadata.hpp"
#include "optics/projector_frames.hpp"
#include "vam-project/match.hpp"
#include "vam-project/show.hpp"
#include "vam-project/turn.hpp"

namespace vam::project {

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

}  // namespace vam::project

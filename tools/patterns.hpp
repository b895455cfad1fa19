// vam-project --pattern: test pictures to a screen or to files.
#pragma once

#include <span>
#include <string>

#include "base/log.hpp"
#include "cli/app.hpp"
#include "device/interrupt.hpp"
#include "io/frame_sink.hpp"
#include "live.hpp"
#include "optics/frames.hpp"
#include "optics/patterns.hpp"

namespace vam::tool {

struct PatternOptions {
  optics::PatternPlan plan;
  double hold_s = 0.5;
  bool repeat = false;
};

inline void add_patterns(cli::App& app, PatternOptions& options) {
  options.plan.name.clear();
  app.group("Test pictures (instead of a sinogram)");
  app.option(
      "--pattern", "NAME", options.plan.name,
      "star (focus), axis, grid, grey, ramp (uniform levels from 0 to full) or sweep (a line across the columns).");
  app.option("--level", "PART", options.plan.level, {0, 1}, "Grey of lines and fields, as a part of full grey.");
  app.option("--pitch", "PX", options.plan.pitch_px, {1, 100000}, "Of grid lines, and step of the sweep.");
  app.option("--width", "PX", options.plan.width_px, {1, 100000}, "Of lines.");
  app.option("--steps", "N", options.plan.steps, {2, 65536}, "Levels of the ramp.");
  app.option("--hold", "S", options.hold_s, {0.001, 86400}, "How long each picture is shown.");
  app.flag("--repeat", options.repeat, "Begin again after the last picture, until a signal comes.");
}

// Columns and rows as the projector is mounted.
inline GreyImage oriented_pattern(const PatternOptions& options, const model::Projector& projector, int n) {
  const GreyImage plain = optics::pattern_frame(options.plan, projector, n);
  Image levels(plain.width, plain.height);
  for (std::size_t i = 0; i < plain.values.size(); ++i) levels.values[i] = plain.values[i];
  optics::orient(levels, projector.orientation);
  GreyImage turned(levels.width, levels.height, plain.bits);
  for (std::size_t i = 0; i < levels.values.size(); ++i)
    turned.values[i] = static_cast<std::uint16_t>(levels.values[i]);
  return turned;
}

inline io::ProjectorFrame pattern_as_frame(const GreyImage& levels, double time_s) {
  io::ProjectorFrame frame;
  frame.levels = levels;
  frame.intensity = Image(levels.width, levels.height);
  for (std::size_t i = 0; i < levels.values.size(); ++i) {
    frame.intensity.values[i] = static_cast<float>(levels.values[i]) / static_cast<float>(levels.full());
  }
  frame.time_s = time_s;
  return frame;
}

inline void run_pattern(const cli::App& app, const PatternOptions& options, const LiveOptions& live_options,
                        const std::string& output, const io::StackOptions& stack, const model::Projector& projector) {
  const int count = optics::pattern_frames(options.plan, projector);
  if (device::names_display(output)) {
    return device::interruptible([&] {
      Live live(live_options, output, {projector.columns, projector.rows, 60});
      for (int n = 0; n < count; ++n) live.add(oriented_pattern(options, projector, n));
      live.play_through(options.hold_s, options.repeat);
    });
  }
  model::StackInfo info;
  info.kind = model::Kind::frames;
  info.space = model::Space::projector;
  info.width = projector.columns;
  info.height = projector.rows;
  info.count = count;
  info.pixel_mm = projector.pixel_mm;
  info.row_mm = -projector.pixel_mm;
  info.z_start_mm = projector.axis_row * projector.pixel_mm;
  info.units = "fraction of full grey";
  info.history.push_back(app.history());
  const auto sink = io::open_frame_sink(output, {info, 1 / options.hold_s, projector.bits, stack});
  for (int n = 0; n < count; ++n) {
    const io::ProjectorFrame frame = pattern_as_frame(oriented_pattern(options, projector, n), n * options.hold_s);
    sink->write(std::span(&frame, 1));
  }
  sink->commit();
}

}  // namespace vam::tool

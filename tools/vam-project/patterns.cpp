// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/patterns.hpp"

#include <span>
#include <vector>

#include "base/index.hpp"
#include "base/text/json.hpp"
#include "device/open/open.hpp"
#include "device/os/interrupt.hpp"
#include "io/image/frame_sink.hpp"
#include "model/rows.hpp"
#include "optics/patterns.hpp"
#include "optics/projector_frames.hpp"
#include "vam-project/live.hpp"

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

}  // namespace

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

}  // namespace vam::project

// vam-project's live half: a display, a light engine and the table's angle behind the sink that files have, too.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/error.hpp"
#include "cli/app.hpp"
#include "device/event_log.hpp"
#include "device/interrupt.hpp"
#include "device/player.hpp"
#include "io/frame_sink.hpp"

namespace vam::tool {

struct LiveOptions {
  std::string follow;
  std::string light;
  std::string log;
  std::optional<double> latency_ms;
  int max_led_current = 0;
  double allowed_missed = device::PlayPlan{}.allowed_missed;
  std::optional<int> frames_per_turn;
  bool with_parent = false;
};

inline void add_live(cli::App& app, LiveOptions& options) {
  app.group("Live output");
  app.option("--follow", "FILE", options.follow,
             "Take the stage's angle from these lines of vam-stage spin, a FIFO or - (then name the sinogram).");
  app.option("--light", "DEVICE", options.light, "Light engine: dlpc350:, dlpc900: or sim:.");
  app.option("--frames-per-turn", "N", options.frames_per_turn, {1, 1000000},
             "Frames to preload; without it one for each angle of the sinogram.");
  app.option("--latency", "MS", options.latency_ms, {-1000, 1000},
             "From the vertical blank to the light; without it projector.latency_ms.");
  app.option("--missed", "PART", options.allowed_missed, {0, 1}, "End when more of all vertical blanks are missed.");
  app.option("--log", "FILE", options.log, "Append a JSON line for every flip: time, frame, angle.");
  app.flag("--die-with-parent", options.with_parent, "Go black and end when the process that started this one ends.");
}

/// The instrument, taken before any frame is read: a second user learns at once that it is in use.
class Live {
 public:
  Live(const LiveOptions& options, const std::string& output, const device::DisplayMode& wanted)
      : options_(options), log_(options.log), clock_(device::real_clock()) {
    if (options.with_parent) device::end_with_parent();
    if (!options.light.empty()) {
      light_ = device::open_light(options.light, options.max_led_current, &guardian_);
      light_->prepare();
    }
    display_ = device::open_display(output, wanted, clock_, &guardian_);
    const auto mode = display_->mode();
    log_("display", {{"device", output}, {"columns", mode.columns}, {"rows", mode.rows}, {"hz", mode.hz}});
  }

  void add(const GreyImage& levels) {
    device::check_interrupted();
    display_->add(levels);
    ++frames_;
  }

  /// One turn's frames are loaded: prints with them.
  device::PlayTally play(double speed_deg_s, int turns) {
    const auto angles = options_.follow.empty() ? device::elapsed_angle(speed_deg_s, clock_)
                                                : device::followed_angle(options_.follow, clock_);
    device::PlayPlan plan;
    plan.frames_per_turn = frames_;
    plan.turns = turns;
    plan.latency_s = 1e-3 * options_.latency_ms.value_or(0);
    plan.allowed_missed = options_.allowed_missed;
    const auto tally = device::play(*display_, light_.get(), *angles, clock_, plan, logger());
    log_("end", {{"flips", tally.flips}, {"lit", tally.lit}, {"missed", tally.missed}});
    return tally;
  }

  /// Shows the loaded frames one after the other.
  device::PlayTally play_through(double hold_s, bool forever) {
    return device::play_through(*display_, light_.get(), clock_, frames_, hold_s, forever, logger());
  }

 private:
  std::function<void(const device::FlipRecord&)> logger() {
    return [this](const device::FlipRecord& record) {
      guardian_.beat();
      log_.line(device::to_json(record));
    };
  }

  LiveOptions options_;
  device::Guardian guardian_;  // first: it forks before any thread, window or device
  device::EventLog log_;
  device::Clock& clock_;
  std::unique_ptr<device::LightEngine> light_;
  std::unique_ptr<device::Display> display_;
  int frames_ = 0;
};

/// Preloads what it is given; commit() plays it.
class LiveSink final : public io::FrameSink {
 public:
  LiveSink(Live& live, double speed_deg_s, int turns) : live_(live), speed_deg_s_(speed_deg_s), turns_(turns) {}
  void write(std::span<const io::ProjectorFrame> frames) override {
    for (const auto& frame : frames) live_.add(frame.levels);
  }
  void commit() override { tally = live_.play(speed_deg_s_, turns_); }

  device::PlayTally tally;

 private:
  Live& live_;
  double speed_deg_s_;
  int turns_;
};

/// The same for frames that belong to times: each is held for `hold_s`, once.
class LiveSequence final : public io::FrameSink {
 public:
  LiveSequence(Live& live, double hold_s) : live_(live), hold_s_(hold_s) {}
  void write(std::span<const io::ProjectorFrame> frames) override {
    for (const auto& frame : frames) live_.add(frame.levels);
  }
  void commit() override { tally = live_.play_through(hold_s_, false); }

  device::PlayTally tally;

 private:
  Live& live_;
  double hold_s_;
};

}  // namespace vam::tool

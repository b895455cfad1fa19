// SPDX-License-Identifier: GPL-3.0-or-later
// vam-project's live half: a display, a light engine and the stage's angle behind the sink that files have, too.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/text/json.hpp"
#include "device/os/event_log.hpp"
#include "device/os/log_keeper.hpp"
#include "device/projector/light_engine.hpp"
#include "device/projector/player.hpp"
#include "device/projector/relayed_lamp.hpp"
#include "device/safety/relay.hpp"
#include "io/image/frame_sink.hpp"
#include "vam-project/options.hpp"

namespace vam::project {

/// The instrument, taken before any frame is read: a second user learns at once that it is in use.
class Live {
 public:
  Live(const LiveOptions& options, const std::string& output, const device::DisplayMode& wanted);

  void add(const GreyImage& levels);
  /// A line of the log that is no flip.
  void note(const std::string& event, const Json& facts) { log_(event, facts); }
  /// Frames in place of those that are shown, from the next turn on; from any thread. Others that have not been shown
  /// yet are dropped, which is logged.
  struct Offer {
    device::ScreenFrames frames;  // once taken those they have replaced, whose memory is given back elsewhere
    Json facts;                   // what of them is logged then
    int from_turn = 0;            // at which they must be taken; 0: any
    int turns = 0;                // after which the print is dark; 0: as before
    bool taken = false;
  };
  void offer(Offer offer);
  [[nodiscard]] int frames() const { return frames_; }
  [[nodiscard]] device::DisplayMode mode() const { return display_->mode(); }
  /// The frames of whole turns are loaded: prints with them.
  device::PlayTally play(int frames_per_turn, double speed_deg_s, int turns);
  /// Shows the loaded frames one after the other, or in this order.
  device::PlayTally play_through(double hold_s, bool forever, std::vector<int> order = {});

 private:
  void begin();
  int take_offer(int turn);
  void note_unused(const Offer* offer, const std::string& why);
  [[nodiscard]] device::Lamp* lamp();
  device::PlayTally ended(const device::PlayTally& tally);
  std::function<void(const device::FlipRecord&)> logger();

  LiveOptions options_;
  device::Guardian guardian_;                // first: it forks before any thread, window or device
  std::optional<device::LogKeeper> keeper_;  // ends after the log that it keeps
  device::EventLog log_;
  device::Clock& clock_;
  std::unique_ptr<device::Relay> relay_;
  std::unique_ptr<device::LightEngine> light_;
  std::optional<device::RelayedLamp> relayed_;
  std::unique_ptr<device::Display> display_;
  int frames_ = 0;
  std::mutex offering_;
  std::unique_ptr<Offer> offer_;
};

/// Preloads what it is given; commit() plays it.
class LiveSink final : public io::FrameSink {
 public:
  using Play = std::function<device::PlayTally()>;
  LiveSink(Live& live, Play play) : live_(live), play_(std::move(play)) {}
  void write(std::span<const io::ProjectorFrame> frames) override {
    for (const auto& frame : frames) live_.add(frame.levels);
  }
  void commit() override { tally = play_(); }

  device::PlayTally tally;

 private:
  Live& live_;
  Play play_;
};

}  // namespace vam::project

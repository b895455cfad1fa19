// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/projector/player.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/os/interrupt.hpp"

namespace vam::device {

namespace {

constexpr double light_lead_s = 0.1;  // the engine's own time to come on
constexpr double told_late_s = 0.002;

// On every exit the screen is black and the light off, and this is logged: a reader of the log must not take the last
// image to be still showing.
class DarkOnExit {
 public:
  DarkOnExit(Display& display, Lamp* lamp, const std::function<void(const FlipRecord&)>& log)
      : display_(display), lamp_(lamp), log_(log) {}
  ~DarkOnExit() {
    try {
      if (lamp_ != nullptr) lamp_->cut();
    } catch (...) {
      // The guardian still holds the order.
    }
    try {
      FlipRecord black;
      black.flip = display_.present(-1);
      log_(black);
    } catch (...) {
      // The display's destructor and the guardian come next.
    }
  }
  DarkOnExit(const DarkOnExit&) = delete;
  DarkOnExit& operator=(const DarkOnExit&) = delete;

 private:
  Display& display_;
  Lamp* lamp_;
  const std::function<void(const FlipRecord&)>& log_;
};

// When the vertical blanks are, out of flips that are never early, but late when the machine is busy.
class Blanks {
 public:
  explicit Blanks(double hz) : period_s_(1 / hz) {}
  /// How late the flip was.
  double take(const Flip& flip) {
    const double since_s = static_cast<double>(flip.sequence - last_.sequence) * period_s_;
    if (std::abs(flip.time_s - last_.time_s - since_s) > 0.5 * period_s_) offsets_s_.clear();  // they count anew
    last_ = flip;
    offsets_s_.push_back(flip.time_s - static_cast<double>(flip.sequence) * period_s_);
    if (offsets_s_.size() > remembered) offsets_s_.pop_front();
    return offsets_s_.back() - offset_s();
  }
  [[nodiscard]] double next_s() const { return offset_s() + static_cast<double>(last_.sequence + 1) * period_s_; }

 private:
  static constexpr std::size_t remembered = 16;
  [[nodiscard]] double offset_s() const { return *std::min_element(offsets_s_.begin(), offsets_s_.end()); }
  double period_s_;
  Flip last_;
  std::deque<double> offsets_s_;
};

// Presents, counts and logs.
class Presenter {
 public:
  Presenter(Display& display, const std::function<void(const FlipRecord&)>& log)
      : display_(display), log_(log), blanks_(display.mode().hz) {
    last_ = display_.present(-1);
    blanks_.take(last_);
  }

  void show(int frame, const AngleSample& predicted, bool count) {
    FlipRecord record;
    record.flip = display_.present(frame);
    record.frame = frame;
    record.angle_deg = predicted.angle_deg;
    record.sigma_deg = predicted.sigma_deg;
    record.missed = std::max(0L, record.flip.sequence - last_.sequence - 1);
    record.late_s = blanks_.take(record.flip);
    last_ = record.flip;
    ++tally_.flips;
    if (frame >= 0) ++tally_.lit;
    if (count) tally_.missed += record.missed;
    log_(record);
  }

  [[nodiscard]] double next_s() const { return blanks_.next_s(); }
  [[nodiscard]] const PlayTally& tally() const { return tally_; }

 private:
  Display& display_;
  const std::function<void(const FlipRecord&)>& log_;
  Blanks blanks_;
  Flip last_;
  PlayTally tally_;
};

void require_flips(const PlayTally& tally, double expected, double allowed, const char* when) {
  if (static_cast<double>(tally.missed) <= allowed * expected) return;
  throw Error{Fault::busy, "display: missed " + std::to_string(tally.missed) + " vertical blanks " + when +
                               " (allowed " + format_number(100 * allowed) + " % of " +
                               format_number(std::floor(expected)) +
                               "); stop other programs or use a lower refresh rate"};
}

}  // namespace

Json to_json(const FlipRecord& record) {
  Json line{{"sequence", record.flip.sequence}};
  line["frame"] = record.frame;
  line["angle_deg"] = record.angle_deg;
  line["sigma_deg"] = record.sigma_deg;
  if (record.missed > 0) line["missed"] = record.missed;
  if (record.late_s > told_late_s) line["late_ms"] = 1e3 * record.late_s;
  return line;
}

PlayTally play(Display& display, Lamp* lamp, AngleSource& angles, Clock& clock, const PlayPlan& plan,
               const std::function<void(const FlipRecord&)>& log) {
  const DarkOnExit dark(display, lamp, log);
  Presenter presenter(display, log);
  const double step_deg = 360.0 / plan.frames_per_turn;
  int turns = plan.turns;
  double end_deg = 360.0 * turns;
  const long loaded = plan.frames > 0 ? plan.frames : plan.frames_per_turn;
  bool light_is_on = false;
  int turn = static_cast<int>(plan.from_deg / 360);
  for (;;) {
    check_interrupted();  // a display with blanks of its own never sleeps by the clock
    bool switched = false;
    angles.update();
    // The frame is on from the next blank, plus the projector's latency, for one period: its angle is that in between.
    const double period_s = 1 / display.mode().hz;
    const double next_s = std::max(presenter.next_s(), clock.now_s());
    const auto predicted = angles.at(next_s + plan.latency_s + 0.5 * period_s);
    if (!predicted) {
      presenter.show(-1, {}, false);
      continue;
    }
    const double speed_deg_s = (angles.at(next_s + 1)->angle_deg - angles.at(next_s)->angle_deg);
    const double expected = std::abs(end_deg / std::max(speed_deg_s, 1e-9)) * display.mode().hz;
    if (predicted->angle_deg >= end_deg) break;
    const bool lit = predicted->angle_deg >= plan.from_deg;
    if (!light_is_on && predicted->angle_deg >= plan.from_deg - light_lead_s * speed_deg_s && speed_deg_s > 0) {
      require_flips(presenter.tally(), expected, plan.allowed_missed, "in the run-up");
      if (lamp != nullptr) lamp->on();
      light_is_on = switched = true;
    }
    const auto nearest = static_cast<long>(std::lround(predicted->angle_deg / step_deg));
    // The last half step belongs to the first frame of a turn that is not shown.
    if (lit && nearest / plan.frames_per_turn > turn && nearest < long{plan.frames_per_turn} * turns) {
      turn = static_cast<int>(nearest / plan.frames_per_turn);
      const int left = plan.next_turn ? plan.next_turn(turn) : 0;
      if (left > 0) turns = std::min(plan.turns, turn + left);
      end_deg = 360.0 * turns;
    }
    // The engine's answer may take a blank, while all is black.
    const bool counted = predicted->angle_deg >= plan.from_deg - 360 && !switched;
    presenter.show(lit ? static_cast<int>(nearest % loaded) : -1, *predicted, counted);
    const double allowed = std::max(plan.allowed_missed, plan.allowed_missed_lit);
    if (lit) require_flips(presenter.tally(), expected, allowed, "in the print");
  }
  presenter.show(-1, *angles.at(clock.now_s()), false);
  if (lamp != nullptr) lamp->dark();  // here, where an engine that stays lit is an error
  return presenter.tally();
}

PlayTally play_through(Display& display, Lamp* lamp, Clock& clock, const std::vector<int>& order, double hold_s,
                       bool forever, const std::function<void(const FlipRecord&)>& log) {
  const DarkOnExit dark(display, lamp, log);
  Presenter presenter(display, log);
  if (lamp != nullptr) lamp->on();
  const double start_s = clock.now_s();
  for (;;) {
    check_interrupted();
    const auto n = static_cast<std::size_t>(std::max(0.0, (presenter.next_s() - start_s) / hold_s));
    if (!forever && n >= order.size()) break;
    presenter.show(order[n % order.size()], {}, true);
  }
  presenter.show(-1, {}, false);
  if (lamp != nullptr) lamp->dark();
  return presenter.tally();
}

}  // namespace vam::device

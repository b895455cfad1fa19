// SPDX-License-Identifier: GPL-3.0-or-later
// A print's light: at every vertical blank the frame that belongs to the stage's angle.
#pragma once

#include <functional>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "device/projector/display.hpp"
#include "device/projector/lamp.hpp"
#include "device/stage/angle_source.hpp"

namespace vam::device {

struct PlayPlan {
  int frames_per_turn = 360;  // frame n belongs to the angle 360 n / frames_per_turn
  int frames = 0;             // loaded, of whole turns that follow each other again and again; 0: of one turn
  int turns = 1;
  double from_deg = 0;               // black before this angle: the rest of a print
  double latency_s = 0;              // from a vertical blank to the light, calibrated
  double allowed_missed = 0.001;     // part of all vertical blanks, by the end of the run-up
  double allowed_missed_lit = 0.01;  // by the end of the print: a vial is not lost to a few
  /// Called before the first frame of every turn but the first; may change frames. Returns for how many turns from
  /// this one on there is light, of those planned at most; 0: as before.
  std::function<int(int turn)> next_turn;
};

/// One flip, as it is logged.
struct FlipRecord {
  Flip flip;
  int frame = -1;        // -1: black
  double angle_deg = 0;  // predicted for the middle of its showing
  double sigma_deg = 0;
  long missed = 0;    // vertical blanks between the flip before and this one
  double late_s = 0;  // after the vertical blank that it counts as
};
/// What of it is logged besides its time.
[[nodiscard]] Json to_json(const FlipRecord& record);

struct PlayTally {
  long flips = 0;
  long lit = 0;
  long missed = 0;  // while lit or in the run-up
};

/// Shows black until the predicted angle at the next vertical blank is plan.from_deg, then for every vertical blank the
/// frame nearest to the angle in the middle of its showing, then black from 360 * turns on. The lamp (may be null)
/// goes on a tenth of a second before that and off right after the last frame. The run-up is a dry run, and
/// judged more strictly: a frame that stays on for a blank too long costs little of a print, a print that ends costs
/// the vial. Throws Fault::busy when more than the allowed part of flips is missed, before light when that was in the
/// run-up; and what display, light and source throw. Black and dark whenever it leaves.
PlayTally play(Display& display, Lamp* lamp, AngleSource& angles, Clock& clock, const PlayPlan& plan,
               const std::function<void(const FlipRecord&)>& log);

/// Shows the frames of `order` one after the other, each for hold_s, with light, once or until a signal. For test
/// patterns.
PlayTally play_through(Display& display, Lamp* lamp, Clock& clock, const std::vector<int>& order, double hold_s,
                       bool forever, const std::function<void(const FlipRecord&)>& log);

}  // namespace vam::device

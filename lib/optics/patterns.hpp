// SPDX-License-Identifier: GPL-3.0-or-later
// Test images to adjust and measure a projector with, in its own grey levels: no response table is applied.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/pixels.hpp"
#include "model/printer.hpp"

namespace vam::optics {

/// star: 36 spokes about the middle, for focus · axis: the rotation axis' column and the row of z = 0 · grid: lines
/// every pitch_px from the axis outwards · grey: one uniform level · ramp: `steps` uniform frames from 0 to full ·
/// sweep: a line of width_px that steps by pitch_px from the first column to the last, one position a frame · row: a
/// level line of width_px at z = 0, whose beam a camera at the side sees from end to end · blink: a black and a level
/// field, in an order that repeats nothing.
struct PatternPlan {
  std::string name = "grid";
  double level = 1;   // of the lines or the field, fraction of full grey
  int pitch_px = 16;  // grid and sweep
  int width_px = 1;   // of lines
  int steps = 17;     // ramp
};
inline constexpr int sweep_line_px = 4;  // pitch and width of a sweep where none is given
[[nodiscard]] const std::vector<std::string>& pattern_names();

/// The plan with these, or else the pattern's own, pitch and width.
void set_lines(PatternPlan& plan, std::optional<int> pitch_px, std::optional<int> width_px);

/// How many frames the pattern has: 1 but for ramp, sweep and blink. Throws Fault::usage for a name that is none.
[[nodiscard]] int pattern_frames(const PatternPlan& plan, const model::Projector& projector);

/// Frame n, of the projector's size and bits, before its orientation. The lit columns of sweep frame n begin at
/// n * pitch_px.
[[nodiscard]] GreyImage pattern_frame(const PatternPlan& plan, const model::Projector& projector, int n);

/// The frames in the order in which they are shown: each once, but those of blink by a sequence of 127 steps in which
/// every two sections, also of every second or nth step, differ in half of their steps [physics §10]. Throws as above.
[[nodiscard]] std::vector<int> pattern_order(const PatternPlan& plan, const model::Projector& projector);

}  // namespace vam::optics

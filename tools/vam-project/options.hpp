// SPDX-License-Identifier: GPL-3.0-or-later
// What the user asks of vam-project, for all its files.
#pragma once

#include <optional>
#include <string>

#include "cli/app.hpp"
#include "cli/common.hpp"
#include "device/projector/player.hpp"
#include "io/image/frame_sink.hpp"
#include "model/printer.hpp"
#include "optics/patterns.hpp"

namespace vam::project {

struct LiveOptions {
  std::string follow;
  std::string light;
  std::string log;
  std::optional<double> latency_ms;
  double max_led_current_percent = 0;
  std::string relay;
  double allowed_missed = device::PlayPlan{}.allowed_missed;
  double allowed_missed_lit = device::PlayPlan{}.allowed_missed_lit;
  std::optional<int> frames_per_turn;
  double from_deg = 0;
  bool with_parent = false;
  std::string frames_from;  // folder
};

struct PatternOptions {
  optics::PatternPlan plan;
  std::optional<int> pitch_px, width_px;
  double hold_s = 0.5;
  bool repeat = false;
};

struct Options {
  std::string input = "-";
  std::string output = "-";
  std::optional<double> fps, print_speed_mm_h, speed_deg_s, turns, flatland_mm, full_scale;
  std::optional<int> bits;
  std::string orientation;
  double column_offset = 0;
  double row_offset = 0;
  double multiplier = 1;
  std::optional<int> dither_turns;
  cli::PrinterOptions printer;
  bool accept_printer = false;
  bool accept_dose = false;
  bool only_plan = false;
  std::string freeze;
  io::StackOptions stack;
  std::string report;
  LiveOptions live;
  PatternOptions pattern;
};

/// Of output to files. Throws Fault::usage when an option of live output is given, or the output looks like a display
/// but is of no known kind.
[[nodiscard]] bool is_live(const cli::App& app, const std::string& output);

void declare(cli::App& app, Options& options);
/// The printer as options change it, that of a stack with these facts, and what options take from it. Throws
/// Fault::usage for a depth no projector has.
[[nodiscard]] model::Printer settle(Options& options, const model::Metadata& facts);

}  // namespace vam::project

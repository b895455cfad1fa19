// SPDX-License-Identifier: GPL-3.0-or-later
// New light for the rest of a running print, from the volume of a turn: it takes the place of the old one at the begin
// of a turn, and ends the print.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "cli/app.hpp"
#include "device/os/child.hpp"
#include "device/os/event_log.hpp"
#include "io/settings/flip_log.hpp"

namespace vam::correct_tool {

/// The command vam-correct renew.
void add_renew(cli::App& app);

struct RenewOptions {
  std::string run, target, curve;
  int iterations = 12;
  double max_uncertainty_percent = 3;
  double axis_sigma_px = 0;
  double lead = 0.5;
  std::optional<int> once, guard;
};

/// "scatter-0007.vdb", as vam-ost --live calls the volume of a turn.
[[nodiscard]] std::string scatter_name(int number);

class Renewal {
 public:
  /// Throws Error: no_input (files of the run), data (a sinogram without a plan), no_output.
  explicit Renewal(const RenewOptions& options);

  /// The volume of this number; what becomes of it is logged in renewed.jsonl. Returns why the print goes on as it
  /// does; empty: there is new light. Throws device::Interrupted.
  std::string take(int number);

 private:
  /// What is known of the print when it is looked at.
  struct Moment {
    double seen_s = 0, at_s = 0;
    int from_turn = 0;
    std::vector<std::string> sinograms;  // that were shown, or are published: the last one goes on
    std::string flips;                   // the log as it will be at that turn
    std::string before;                  // report of an earlier turn; empty: none
  };
  void renew(int number);
  [[nodiscard]] Moment look(int number) const;
  void expect(Moment& moment, int turn, const io::FlipLog& log) const;
  void attempt(const std::vector<std::string>& words) const;
  void publish(int from_turn);
  [[nodiscard]] std::vector<std::string> doses(const std::string& flag, const Moment& moment, double before_s,
                                               const std::vector<double>& offsets_px) const;
  [[nodiscard]] double elapsed_s() const;
  [[nodiscard]] std::string file(const std::string& name) const { return options_.run + "/" + name; }
  [[nodiscard]] std::string scratch(const std::string& name) const { return scratch_.path() + "/" + name; }

  RenewOptions options_;
  double planned_turns_ = 0, multiplier_ = 0;  // at full intensity as planned; 1 is full intensity
  double speed_deg_s_ = 0, delay_s_ = 0, lead_deg_ = 0;
  std::chrono::steady_clock::time_point begun_;
  device::TemporaryFolder scratch_;
  device::EventLog log_;
};

}  // namespace vam::correct_tool

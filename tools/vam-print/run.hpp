// SPDX-License-Identifier: GPL-3.0-or-later
// One print: what it was armed with, where its records are, what became of its tools.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "device/os/child.hpp"
#include "device/os/event_log.hpp"
#include "io/settings/flip_log.hpp"
#include "model/printer.hpp"
#include "vam-print/options.hpp"

namespace vam::print_tool {

using device::Child, device::Command, device::Manner, device::Redirection, device::Talk;
using device::run_to_end, device::text_of, device::last_line, device::pass_on;

/// Ends vam-print with this status when all has been said.
struct Ended {
  int status;
};

struct Run {
  explicit Run(const Options& given);

  Options options;
  Talk talk;
  std::string begun;                       // UTC
  std::string folder;                      // of the records
  std::string frozen;                      // the resumed run whose settings are these; empty: none
  std::vector<std::string> printer_words;  // --printer FILE --set KEY=VALUE ...
  std::vector<std::string> scans;          // calibration that is required
  model::Printer printer;                  // in force
  std::string resumed_utc;                 // when the print was armed of which this is the rest
  int turns = 0;
  double from_deg = 0;       // where light begins
  double planned_turns = 0;  // of a print that is corrected; until where it goes on in open loop
  std::string sinogram_sha256;
  int lock = -1;  // on the events, until the last tool has ended, so that nobody takes the print for one that is over

  std::string outcome = "aborted";
  std::map<std::string, int> statuses;   // of the tools that have ended
  std::optional<double> open_loop_from;  // the turn at which the views were lost
  std::optional<double> dark_s;          // when vam-project was seen to have ended

  std::optional<io::FlipLog> light;  // that was shown

  [[nodiscard]] std::string file(const std::string& name) const { return folder + "/" + name; }
  /// Takes in what was added to `light`; a line that is none of a log of flips ends what is known.
  void look();
  [[nodiscard]] bool is_lit() const { return light && light->lit() > 0; }
  /// Or its log cannot be read.
  [[nodiscard]] bool may_be_lit() const { return is_lit() || light_lost_; }
  /// New projections were shown; they say when they end.
  [[nodiscard]] bool is_corrected() const { return light && light->end_turn(); }
  /// Up to the last flip.
  [[nodiscard]] double turns_shown() const;
  /// An event, if the disk has room for it; from any thread, once there was one.
  void note(const std::string& event, const Json& facts);
  void note(const std::string& event);
  /// Runs a command, which says why it fails: what it printed, into `output` if that is given. Throws Ended.
  std::string require(const Command& command, const std::string& output = "");
  /// Shows what a tool said, and throws Ended.
  [[noreturn]] void fail(const std::string& tool, int status) const;

  /// The events so far are on the disk.
  void keep_events();

 private:
  std::unique_ptr<device::EventLog> events_;
  bool light_lost_ = false;
};

/// Between the tools, in the folder of the run.
inline constexpr std::array pipes{".stage", ".project", ".capture", ".views"};

/// Something moved, was lit or taken.
[[nodiscard]] bool is_used(const Run& run);

/// Where vam-project was killed: when its last image went off, of which its log says nothing.
void log_dark(const Run& run);

/// summary.json and SHA256SUMS, and what the tools said. Throws Error where the disk has no room.
void write_summary(const Run& run, int status);

}  // namespace vam::print_tool

// SPDX-License-Identifier: GPL-3.0-or-later
// One print: what it was armed with, where its records are, what became of its tools.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "device/os/event_log.hpp"
#include "model/printer.hpp"
#include "vam-print/child.hpp"
#include "vam-print/options.hpp"
#include "vam-print/talk.hpp"

namespace vam::print_tool {

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
  int turns = 0;
  double from_deg = 0;       // where light begins
  double planned_turns = 0;  // of a print that is corrected; until where it goes on in open loop
  std::string sinogram_sha256;

  std::string outcome = "aborted";
  std::map<std::string, int> statuses;   // of the tools that have ended
  std::optional<double> open_loop_from;  // the turn at which the views were lost
  std::optional<double> dark_s;          // when vam-project was seen to have ended

  [[nodiscard]] std::string file(const std::string& name) const { return folder + "/" + name; }
  /// An event, if the disk has room for it.
  void note(const std::string& event, const Json& facts);
  void note(const std::string& event);
  /// Runs a command, which says why it fails: what it printed, into `output` if that is given. Throws Ended.
  std::string require(const Command& command, const std::string& output = "");
  /// Shows what a tool said, and throws Ended.
  [[noreturn]] void fail(const std::string& tool, int status) const;

 private:
  std::unique_ptr<device::EventLog> events_;
};

/// Lets a folder's new names and these files reach the disk, as far as it can.
void bring_to_disk(const std::vector<std::string>& files);

}  // namespace vam::print_tool

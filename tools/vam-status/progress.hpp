// SPDX-License-Identifier: GPL-3.0-or-later
// How far a print is, by the logs in its run folder.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/settings/flip_log.hpp"
#include "model/printer.hpp"

namespace vam::status_tool {

/// A calibration record in force.
struct RecordAge {
  std::string scan;
  std::string utc, valid_until, status;
};

/// What the run folder says at one moment. Angles are stage angles in degrees; light comes on at from_deg.
struct PrintProgress {
  double turns = 0;  // of the whole print; 0: not known
  double from_deg = 0;
  double angle_deg = 0;                  // of the last stage sample
  std::optional<double> given_fraction;  // of the light of this run: 0 to 1; none without turns or settings
  long missed = 0;                       // vertical blanks, of `blanks`, from the last run-up turn on
  long blanks = 0;
  std::optional<double> missing_percent;  // of the part, by live metrology
  std::optional<std::string> outcome;     // when it has ended
  int status = 0;
  double silent_s = 0;     // since the last entry of a log
  std::string resumed_by;  // the print that shows the rest; empty: none
  bool abandoned = false;  // it is silent or at its planned end, and nobody writes: vam-print was killed
  std::vector<std::string> simulated;
  std::vector<RecordAge> records;
};

/// Follows the logs of one run.
class RunFolder {
 public:
  /// Throws Fault::no_input where there is no such folder, Fault::data where it is none of vam-print, or its logs are
  /// not those of which SHA256SUMS has the hashes.
  explicit RunFolder(const std::string& path);

  /// Reads what has been added.
  void read();
  [[nodiscard]] const PrintProgress& progress() const { return progress_; }
  /// The run's frozen settings.
  [[nodiscard]] const model::Printer& printer() const { return printer_; }
  /// Images of the sinogram that the print began with.
  [[nodiscard]] std::vector<io::ShownImage> shown() const;
  /// Whether others have taken its place.
  [[nodiscard]] bool renewed() const;
  [[nodiscard]] std::string file(const std::string& name) const;

 private:
  void load_settings();  // once; before a print is armed there may be none
  void read_events();
  void read_summary();
  void read_angle();
  void read_flips();
  void look_for_end();
  void read_records();

  std::string path_;
  model::Printer printer_;
  bool settled_ = false;
  std::optional<io::FlipLog> flips_;
  bool warned_ = false;       // that there is no list of hashes
  std::optional<bool> held_;  // the events, by vam-print; none where there are none
  PrintProgress progress_;
};

/// "3.41 of 20", "3.41 of unknown" while events.jsonl has no number of turns.
[[nodiscard]] std::string turn_text(const PrintProgress& progress);
/// "147.6 deg", within a turn.
[[nodiscard]] std::string angle_text(const PrintProgress& progress);
/// "17.0 %" or "unknown", likewise.
[[nodiscard]] std::string given_text(const PrintProgress& progress);
/// "printing  turn 3.41 of 20  angle 147.6 deg  dose delivered 17 % ..."
[[nodiscard]] std::string status_line(const PrintProgress& progress, double speed_deg_s);
/// "preparing", "run-up, dark", "printing", "ended: done", ...
[[nodiscard]] std::string state_of(const PrintProgress& progress);

}  // namespace vam::status_tool

// SPDX-License-Identifier: GPL-3.0-or-later
// The flips of a print, from the log of vam-project: what was shown when, and at which stage angle.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/log/log_lines.hpp"
#include "base/text/json_fwd.hpp"

namespace vam::io {

/// An image that was on the screen, with light.
struct ShownImage {
  double angle_deg = 0;  // of the stage in the middle of its showing
  double seconds = 0;    // until the next flip; of the last one of a run that was killed, as long as the one before
};

/// A sinogram as the log states it.
struct ShownSinogram {
  std::string sha256;     // empty: it came through a pipe
  double full_scale = 0;  // its value at full intensity
  std::string name = {};  // of its file, where it then was
};

/// A line of the log, where the image changed.
struct LoggedFlip {
  double t_s = 0;  // CLOCK_MONOTONIC
  int frame = -1;  // -1: dark
  double angle_deg = 0;
  long missed = 0;  // vertical blanks since the flip before
};

/// The log of a print, also of one that goes on.
class FlipLog {
 public:
  /// flips.jsonl, or the run folder (vam-print) that holds it. Throws Fault::no_input, Fault::data for no regular file.
  explicit FlipLog(const std::string& path);

  /// Takes in the whole lines that were added since the last call. Throws Fault::data for another kind of file, and for
  /// numbers that no print has: frames are those that the log states, images are shown at 0 deg or later, within the
  /// turns that it states.
  void read();

  [[nodiscard]] const std::vector<LoggedFlip>& flips() const { return flips_; }
  /// No line of it can have been lost or changed unseen.
  [[nodiscard]] bool is_chained() const { return lines_.is_chained(); }
  /// The lit images so far, in order.
  [[nodiscard]] std::vector<ShownImage> shown() const;
  /// Those of a sinogram, by its SHA-256; where the log does not state it, those of which it states none.
  [[nodiscard]] std::vector<ShownImage> shown_of(const std::string& sha256) const;
  /// From now on all that is shown is what was shown before this time; where the log of a print that goes on has not
  /// reached it, the light goes on as it was last.
  void truncate_at(double t_monotonic_s);
  /// The sinograms that were shown, one after the other; the first of a print, and those that took its place.
  [[nodiscard]] const std::vector<ShownSinogram>& sinograms() const { return sinograms_; }
  /// The turn at which the print ends, as the last sinogram that took the place of another states it; that may be
  /// beyond the print's own turns, at which it ends in any case.
  [[nodiscard]] const std::optional<double>& end_turn() const { return end_turn_; }
  /// Vertical blanks from the last run-up turn on: those at which the image changed late, of all.
  [[nodiscard]] long missed() const { return missed_; }
  [[nodiscard]] long blanks() const { return blanks_; }
  /// Flips to images with light, and the last of them; null: none.
  [[nodiscard]] long lit() const;
  [[nodiscard]] const LoggedFlip* last_lit() const;

 private:
  struct RunPlace {
    bool last = false;  // of its run
    int sinogram = -1;  // -1: not stated
  };
  void take(const Json& event);
  void take_flip(const Json& event);
  void require_possible(const LoggedFlip& flip) const;
  void begin_run();
  template <class Counts>
  [[nodiscard]] std::vector<ShownImage> images(const Counts& counts) const;

  void extrapolate(double image_s, std::vector<ShownImage>& shown) const;

  std::string file_;
  LogLines lines_;
  long frames_ = 0;   // of the print; 0: not stated
  double turns_ = 0;  // likewise
  std::vector<LoggedFlip> flips_;
  std::vector<RunPlace> places_;  // theirs
  std::vector<ShownSinogram> sinograms_;
  int sinogram_ = -1;  // that is shown
  std::optional<double> end_s_, end_turn_;
  long missed_ = 0;
  long blanks_ = 0;
};

/// What a run showed of a sinogram.
struct DisplayHistory {
  std::vector<ShownImage> images;
  double full_scale = 0;  // 0: not stated
};
/// Throws as FlipLog and require_sinogram_of(), and Fault::data for a log in which its full scale changes. before_s: as
/// FlipLog::truncate_at().
[[nodiscard]] DisplayHistory read_showing(const std::string& run, const std::string& sinogram,
                                          std::optional<double> before_s = {});

/// Does a run state the hash of its sinogram?
[[nodiscard]] bool states_sinogram(const std::string& run);

/// Throws Fault::data when a sinogram is none of a run's, by the hashes in its events.jsonl and in the log of its
/// flips; and for one that comes through a pipe ("-") where the run showed several. What states no hash is taken on
/// trust.
void require_sinogram_of(const std::string& run, const std::string& sinogram);

/// Stage angles of a sinogram's rows, which are spread evenly over one turn, in either sense.
struct StageRows {
  int count = 0;
  double start_deg = 0;
  double step_deg = 0;
};

/// For how many turns of the stage, at this speed, each row was shown: the sum over images of seconds over the time
/// that the stage spends at a row. A whole print has its turns in each.
[[nodiscard]] std::vector<double> turns_shown(const std::vector<ShownImage>& shown, const StageRows& rows,
                                              double speed_deg_s);

}  // namespace vam::io

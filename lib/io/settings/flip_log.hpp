// SPDX-License-Identifier: GPL-3.0-or-later
// The flips of a print, from the log of vam-project: what was shown when, and at which stage angle.
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace vam::io {

/// An image that was on the screen, with light.
struct ShownImage {
  double angle_deg = 0;  // of the stage in the middle of its showing
  double seconds = 0;    // until the next flip; of the last one of a run that was killed, as long as the one before
};

/// The log of a print, also of one that goes on.
class FlipLog {
 public:
  /// flips.jsonl, or the run folder (vam-print) that holds it. Throws Fault::no_input.
  explicit FlipLog(const std::string& path);

  /// Takes in the whole lines that were added since the last call. Throws Fault::data for another kind of file.
  void read();

  /// The lit images so far, in order.
  [[nodiscard]] std::vector<ShownImage> shown() const;
  /// Those of a sinogram that took the place of another while printing, by its SHA-256; of any other hash those before
  /// the first one did.
  [[nodiscard]] std::vector<ShownImage> shown_of(const std::string& sinogram_sha256) const;
  /// SHA-256 of the sinograms that took the place of others, in order.
  [[nodiscard]] const std::vector<std::string>& renewals() const { return renewals_; }
  /// Vertical blanks from the last run-up turn on: those at which the image changed late, of all.
  [[nodiscard]] long missed() const { return missed_; }
  [[nodiscard]] long blanks() const { return blanks_; }

 private:
  struct LoggedFlip {
    double t_s;
    int frame;
    double angle_deg;
    bool last;            // of its run
    std::size_t renewal;  // how many times the frames had been renewed
  };
  void begin_run();
  template <class Counts>
  [[nodiscard]] std::vector<ShownImage> images(const Counts& counts) const;

  std::string file_;
  std::ifstream stream_;
  int line_ = 0;
  std::vector<LoggedFlip> flips_;
  std::vector<std::string> renewals_;
  std::size_t renewal_ = 0;  // of the run that is read
  long missed_ = 0;
  long blanks_ = 0;
};

/// The lit images in order, of flips.jsonl or of the run folder (vam-print) that holds it. A last line that is cut is
/// left out. Throws Fault::no_input, Fault::data for another kind of file.
[[nodiscard]] std::vector<ShownImage> read_shown(const std::string& run);
/// Those of a sinogram. Throws as require_sinogram_of().
[[nodiscard]] std::vector<ShownImage> read_shown(const std::string& run, const std::string& sinogram);

/// Throws Fault::data when a sinogram is none of a run folder's: neither that in its events.jsonl nor one that took its
/// place while printing, by their hashes. A log alone, and a sinogram that comes through a pipe ("-"), are taken on
/// trust, unless the run showed several.
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

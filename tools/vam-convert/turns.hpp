// SPDX-License-Identifier: GPL-3.0-or-later
// Projections over any stage angles, of one turn or more, as the rows of one turn.
#pragma once

#include <string>
#include <vector>

#include "base/image.hpp"
#include "io/image/any_frames.hpp"
#include "vam-convert/options.hpp"

namespace vam::convert_tool {

/// Do options or the frames state over which stage angles they are shown?
[[nodiscard]] bool are_angles_stated(const Options& options, const io::ImageSource& from);

/// Over which stage angles each projection is shown: from edge n to edge n + 1, not wrapped. By --speed as long as a
/// video shows it; in the middle of even steps, as given, stated or of one turn in all; by frames.csv until half way to
/// the next, the shorter way; the first at --first-angle, all as --from counts them. Throws Fault::usage for a speed
/// without times, Fault::data for what is no angle.
[[nodiscard]] std::vector<double> stage_edges_deg(const Options& options, const io::ImageSource& from, int projections);

class Turns {
 public:
  /// Rows in the median step of the projections, from the first one on, and from the last one on where they are
  /// backwards and no whole number of turns; finer ones, at least 720 a turn, where they are `held` while the stage
  /// turns, or begin between rows. Throws Fault::data that begins with `name` where the stage turns back, and for less
  /// than 0.9 of a turn.
  Turns(const std::vector<double>& edges_deg, bool held, const std::string& name);

  /// Is light of a projection on all rows that the stage passes meanwhile?
  [[nodiscard]] bool blurred() const { return blurred_; }
  [[nodiscard]] int rows() const { return static_cast<int>(shown_.size()); }
  /// Stage angle of the first row, 0 to 360.
  [[nodiscard]] double start_deg() const { return start_deg_; }
  /// From the first edge to the last: the first rows are shown once more than others where it is not whole.
  [[nodiscard]] double count() const { return count_; }
  /// A row for each angle: the mean of what is shown while the stage passes it, each projection by its share of that.
  [[nodiscard]] Image fold(const Image& projections) const;

 private:
  struct Share {
    int projection, row;
    float rows;
  };
  std::vector<Share> shares_;
  std::vector<float> shown_;  // times that each row is passed
  bool blurred_ = false;
  double start_deg_ = 0;
  double count_ = 0;
};

}  // namespace vam::convert_tool

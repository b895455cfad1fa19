// SPDX-License-Identifier: GPL-3.0-or-later
// Even angles made of uneven ones, whatever the camera delivered [OST22 section 2.4].
#pragma once

#include <span>
#include <vector>

namespace vam::metrology {

struct EvenTurn {
  int angles = 0;    // over one full turn, first at 0 deg
  int used = 0;      // frames that contributed
  int repeated = 0;  // of these, frames at an angle that was there already; averaged
};

/// For each of `angles` even angles the two neighbouring frames and their weights, interpolating linearly over the
/// circle; frames closer than a tenth of the even step count as one, their mean. angles = 0 takes the number that the
/// median distance of the frames suggests.
class AngleGrid {
 public:
  /// Throws Fault::data when there are fewer than 8 different angles or a gap is wider than max_gap_deg.
  AngleGrid(std::span<const double> angles_deg, int angles, double max_gap_deg = 15);

  [[nodiscard]] const EvenTurn& summary() const { return summary_; }

  struct Tap {
    int frame;
    float weight;
  };
  /// The frames that make even angle `a`; the weights add up to 1.
  [[nodiscard]] const std::vector<Tap>& taps(int a) const { return taps_[a]; }

 private:
  EvenTurn summary_;
  std::vector<std::vector<Tap>> taps_;
};

/// Frames in the order in which they were taken, over one turn or several. From three turns on, each has even angles of
/// its own and what they show is combined by the median; a last turn that is incomplete is left out. One or two are one
/// AngleGrid, as are frames in another order.
class Turns {
 public:
  /// Throws Fault::data as AngleGrid does.
  explicit Turns(std::span<const double> angles_deg);

  [[nodiscard]] int angles() const { return turns_.front().grid.summary().angles; }

  struct Turn {
    int first;  // frame of the turn; the grid counts from it
    AngleGrid grid;
  };
  [[nodiscard]] const std::vector<Turn>& all() const { return turns_; }

 private:
  std::vector<Turn> turns_;
};

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
// Run-out: the axis of the vial beside that of the stage, seen in the views themselves.
#pragma once

#include <array>

#include "base/text/json_fwd.hpp"

namespace vam::metrology {

/// From the axis of the stage to that of the vial, in the frame of the part.
using RunOutVector = std::array<double, 2>;

/// Result, with one standard deviation.
struct RunOut {
  bool determined = false;  // the rest is without meaning when it is not
  RunOutVector mm{};
  double sigma_mm = 0;  // in any direction
  double column = 0;    // of the stage's axis, found together with it
  double column_sigma = 0;
  /// Absorption of the scattered light, fitted where none is given; where it is seen, run-out is not determined.
  double absorption_per_mm = 0;
  double absorption_sigma_per_mm = 0;

  [[nodiscard]] double size_mm() const;
  /// Farther from 0 than chance takes one of 370.
  [[nodiscard]] bool seen() const;
  /// The scattered light is absorbed by more than chance makes it seem in one of 740 cases, and enough to matter.
  [[nodiscard]] bool absorbs() const;
};

[[nodiscard]] Json to_json(const RunOut& found);

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
// What the flips of a print are, whoever wrote them: a log that breaks these rules states no light that was shown.
#pragma once

#include <optional>
#include <string>

#include "base/text/json_fwd.hpp"

namespace vam::io {

/// A line of a log of vam-project, where an image changed.
struct LoggedFlip {
  double t_s = 0;  // CLOCK_MONOTONIC
  int frame = -1;  // -1: dark
  double angle_deg = 0;
  long missed = 0;               // vertical blanks since the flip before
  std::optional<long> sequence;  // of the vertical blank; vam-print, which ends a log, states none
};

/// Takes the lines of a log one after the other. Numbers must be finite and possible: a frame is one of those that the
/// log states, a lit image is shown at 0 deg or later, within the turns that it states.
class FlipRules {
 public:
  static constexpr double most_s = 1e9;      // 30 years since the machine started
  static constexpr double most_turns = 1e6;  // as of stage.turns
  enum class Order { required, free };
  /// free: of a log that is held to its hash; which flips follow each other is not judged.
  explicit FlipRules(Order order) : ordered_(order == Order::required) {}
  /// A line that is no flip: begins a run, or states frames and turns. Throws as take().
  void note(const Json& event, const std::string& place);
  /// The flip of a line. Within a run time does not go back, nor the stage by 45 deg or more while there is light; no
  /// vertical blanks are missing but those that are logged as missed, and no image stays on for 10 s. Throws
  /// Fault::data, "PLACE: ...".
  LoggedFlip take(const Json& event, const std::string& place);

 private:
  void require_possible(const LoggedFlip& flip, const std::string& place) const;
  void require_order(const LoggedFlip& flip, const std::string& place) const;

  bool ordered_;
  long frames_ = 0;   // 0: not stated
  double turns_ = 0;  // 0: not stated
  std::optional<LoggedFlip> last_;
  std::optional<double> lit_deg_;  // of the last lit image
};

}  // namespace vam::io

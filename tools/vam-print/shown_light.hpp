// SPDX-License-Identifier: GPL-3.0-or-later
// What flips.jsonl says, of a print that goes on or has ended, however it ended.
#pragma once

#include <optional>
#include <string>

#include "base/text/json_fwd.hpp"
#include "io/stream/log_lines.hpp"

namespace vam::print_tool {

/// By whole lines; a line that is none of the log ends what is known.
class ShownLight {
 public:
  struct Flip {
    int frame = -1;  // -1: dark
    double t_s = 0, angle_deg = 0;
  };

  explicit ShownLight(std::string run);
  /// Takes in what was added.
  void read();
  [[nodiscard]] bool any() const { return last_.has_value(); }
  [[nodiscard]] bool lit() const { return lit_ > 0; }
  /// New projections were shown; they say when they end.
  [[nodiscard]] bool corrected() const { return corrected_; }
  [[nodiscard]] const std::optional<Flip>& last() const { return last_; }
  /// Turns up to the last flip.
  [[nodiscard]] double turns() const { return last_ ? last_->angle_deg / 360 : 0; }
  /// turns (to the last image), lit_flips, missed_flips (from the last run-up turn on).
  [[nodiscard]] Json reached() const;

 private:
  void take(const Json& event);

  std::string file_;
  std::optional<io::LogLines> lines_;
  bool broken_ = false, corrected_ = false;
  std::optional<Flip> last_;
  double lit_deg_ = 0;
  long lit_ = 0, missed_ = 0;
};

}  // namespace vam::print_tool

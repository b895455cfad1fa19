// SPDX-License-Identifier: GPL-3.0-or-later
// What the other logs of a run folder prove of its flips: that there were as many, and up to when there was light.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "base/sha256.hpp"
#include "base/text/json_fwd.hpp"
#include "io/stream/log_lines.hpp"

namespace vam::io {

/// The end of a log of flips.
struct FlipsEnd {
  bool lit = false;                          // the last flip has light
  std::optional<double> lit_deg = {};        // of the first flip with light
  std::optional<double> lit_s = {};          // of the last one
  double t_s = 0;                            // of the last flip
  std::optional<double> seals_since_s = {};  // when the log stated that it is sealed
};

/// Nothing is proved of a log by another name than flips.jsonl, or alone in its folder. Of one in a run folder,
/// events.jsonl states how many bytes of whole lines there were, and their hash (vam-project --log-seals); and
/// angles.jsonl how long the stage went on turning. What vam-print armed (events.jsonl) is what vam-project began, and
/// no light of it is without angles.
class LogCrossCheck {
 public:
  explicit LogCrossCheck(const std::string& log);
  /// Takes in what was added to both. Before the log itself is read, which may go on. Throws Fault::data for whole
  /// lines that no print leaves in them.
  void read();
  /// Of an event of the log that begins a sinogram: throws Fault::data where it is not that which was armed.
  void require_armed(const Json& sinogram) const;
  /// After each line of the log: is it the last of those that were sealed?
  bool check(std::uint64_t bytes, const Sha256& hash);
  /// After the last one so far. Throws Fault::data where lines are not those that were sealed, there were more, all
  /// seals are gone, the stage turned on for longer than a tool takes to end, without a flip, or, of a print that was
  /// armed, the angles of its light are gone or light came before the angle at which it was to begin.
  void require_all(std::uint64_t bytes, const FlipsEnd& end) const;
  /// Of a log that is gone: throws Fault::data where there were flips.
  void require_none() const;

 private:
  struct Seal {
    std::uint64_t bytes;
    std::string sha256, utc;
  };
  void read_events();
  void take_armed(const Json& event, const std::string& place);
  void take_seal(const Json& event, const std::string& place);
  void read_angles();
  [[nodiscard]] std::string last_angle() const;
  void require_angles(const FlipsEnd& end) const;

  std::string log_;
  std::optional<LogLines> events_, angles_;
  int event_ = 0, angle_ = 0;  // lines of both that were read
  std::deque<Seal> seals_;     // not reached yet
  std::uint64_t sealed_ = 0;   // bytes by the last seal that was read
  bool has_seals_ = false;
  std::uint64_t reached_ = 0;  // of the log
  std::string problem_;        // told at the end: what a line states is a better one
  std::optional<double> from_deg_;
  double turns_ = 0;
  std::string sinogram_sha256_;
  std::optional<double> began_s_;  // when the stage was at from_deg
  double last_s_ = 0;              // of the stage
  double last_deg_ = 0;
};

/// Of a run folder whose flips are gone: throws Fault::data where there were some.
void require_no_flips(const std::string& log);

}  // namespace vam::io

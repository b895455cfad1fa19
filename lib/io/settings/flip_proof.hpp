// SPDX-License-Identifier: GPL-3.0-or-later
// What the other logs of a run folder prove of its flips: that there were as many, and up to when there was light.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "base/sha256.hpp"
#include "io/stream/log_lines.hpp"

namespace vam::io {

/// The end of a log of flips.
struct FlipsEnd {
  bool lit = false;      // the last flip has light
  bool was_lit = false;  // there was light
  double t_s = 0;        // of the last flip
};

/// Nothing is proved of a log by another name than flips.jsonl, or alone in its folder. Of one in a run folder,
/// events.jsonl states how many bytes of whole lines there were, and their hash (vam-project --log-seals); and
/// angles.jsonl how long the stage went on turning.
class FlipProof {
 public:
  explicit FlipProof(const std::string& log);
  /// Takes in what was added to both. Before the log itself is read, which may go on.
  void read();
  /// After each line of the log.
  void check(std::uint64_t bytes, const Sha256& hash);
  /// After the last one so far. Throws Fault::data where lines are not those that were sealed, there were more, or the
  /// stage turned on for longer than a tool takes to end, without a flip.
  void require_all(std::uint64_t bytes, const FlipsEnd& end) const;

 private:
  struct Seal {
    std::uint64_t bytes;
    std::string sha256, utc;
  };
  void read_events();
  void read_angles();

  std::string log_;
  std::string folder_;  // empty: it proves nothing
  std::optional<LogLines> events_, angles_;
  std::deque<Seal> seals_;  // not reached yet
  std::string problem_;     // told at the end: what a line states is a better one
  std::optional<double> from_deg_;
  std::optional<double> began_s_;  // when the stage was at from_deg
  double last_s_ = 0;              // of the stage
  double last_deg_ = 0;
};

/// Of a run folder whose flips are gone: throws Fault::data where there were some.
void require_no_flips(const std::string& log);

}  // namespace vam::io

// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/flip_rules.hpp"

#include <cmath>
#include <cstdint>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"

namespace vam::io {

namespace {

constexpr std::int64_t most_flips = 100000000;  // frames, and blanks of 100 Hz in 11 days
constexpr double rounding_s = 1e-5;             // of times that vam-print logs
constexpr double most_back_deg = 45;            // what a predicted angle takes back of a stage that stops
constexpr double most_lit_s = 10;               // vam-print ends a print whose images stand still within 3 s

constexpr const char* remedy = "; the log was changed; restore it";

[[noreturn]] void refuse(const std::string& place, const std::string& problem) {
  throw Error{Fault::data, place + ": " + problem + remedy};
}

std::int64_t whole(const Json& event, const char* key, std::int64_t least, const std::string& place) {
  const Json& value = event.at(key);
  const bool fits =
      value.is_number_integer() && (!value.is_number_unsigned() || value.get<std::uint64_t>() <= INT64_MAX);
  if (fits && value.get<std::int64_t>() >= least && value.get<std::int64_t>() <= most_flips)
    return value.get<std::int64_t>();
  refuse(place, std::string(key) + " " + briefly(value.dump()) + " is not a whole number from " +
                    std::to_string(least) + " to " + std::to_string(most_flips));
}

}  // namespace

void FlipRules::note(const Json& event, const std::string& place) {
  const std::string name = text_at(event, "event");
  if (name == "display") *this = FlipRules(ordered_ ? Order::required : Order::free);
  if (name != "sinogram") return;
  frames_ = event.contains("frames") ? whole(event, "frames", 1, place) : 0;
  turns_ = event.contains("turns") ? static_cast<double>(whole(event, "turns", 1, place)) : 0;
}

LoggedFlip FlipRules::take(const Json& event, const std::string& place) {
  LoggedFlip flip;
  flip.t_s = event.at("t_monotonic_s");
  flip.frame = static_cast<int>(whole(event, "frame", -1, place));
  flip.angle_deg = event.at("angle_deg");
  if (event.contains("missed")) flip.missed = whole(event, "missed", 0, place);
  if (event.contains("sequence")) flip.sequence = event.at("sequence").get<long>();
  require_possible(flip, place);
  if (ordered_ && last_) require_order(flip, place);
  last_ = flip;
  if (flip.frame >= 0) lit_deg_ = flip.angle_deg;
  return flip;
}

void FlipRules::require_possible(const LoggedFlip& flip, const std::string& place) const {
  if (!(flip.t_s >= 0 && flip.t_s <= FlipRules::most_s)) {
    refuse(place, "time " + format_number(flip.t_s) + " s is not between 0 and " + format_number(FlipRules::most_s) +
                      " s since the machine started");
  }
  if (frames_ > 0 && flip.frame >= frames_)
    refuse(place,
           "frame " + std::to_string(flip.frame) + " is none of the " + std::to_string(frames_) + " of the print");
  const bool lit = flip.frame >= 0;
  const double turns = turns_ > 0 ? turns_ : FlipRules::most_turns;
  const double least_deg = lit ? 0 : -360 * FlipRules::most_turns;
  const double most_deg = 360 * (lit ? turns : FlipRules::most_turns);
  if (flip.angle_deg >= least_deg && flip.angle_deg <= most_deg) return;
  refuse(place, "angle " + format_number(flip.angle_deg) + " deg is not between " + format_number(least_deg) + " and " +
                    format_number(most_deg) + " deg" + (lit ? ", where images are shown" : ""));
}

void FlipRules::require_order(const LoggedFlip& flip, const std::string& place) const {
  const double passed_s = flip.t_s - last_->t_s;
  if (passed_s < -rounding_s)
    refuse(place, "time goes back by " + format_number(-passed_s, 4) + " s from that of the flip before");
  const bool lit = flip.frame >= 0;
  if (lit && lit_deg_ && flip.angle_deg <= *lit_deg_ - most_back_deg) {
    refuse(place, "the angle goes back from " + format_number(*lit_deg_, 6) + " to " +
                      format_number(flip.angle_deg, 6) + " deg, while the stage turns on");
  }
  if (last_->frame >= 0 && passed_s > most_lit_s)
    refuse(place, "the image before stayed on for " + format_number(passed_s, 4) + " s, which no print leaves on");
  if (!lit || !flip.sequence || !last_->sequence) return;  // the last, dark flip does not count what was missed
  const long lost = *flip.sequence - *last_->sequence - 1 - flip.missed;
  if (lost > 0) refuse(place, "flips are missing before it (vertical blanks: " + std::to_string(lost) + ")");
}

}  // namespace vam::io

// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/log_cross_check.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "io/settings/flip_rules.hpp"

namespace vam::io {

namespace {

// What a stage still turns when the projector's tool has ended: vam-print ends it within a second, or it ends by
// itself; and a power failure loses up to a second of flips.
constexpr double most_alone_s = 2;
// The first seal, of no bytes, precedes the light; a power failure loses it if the disk was busy.
constexpr double most_unsealed_s = 5;
// Light without a stage angle: vam-project ends it after 0.5 s. It has each line from tee, which has written it to the
// log by then, so that a kill loses none; a power failure loses those since the log was last brought to the disk, which
// vam-print does every second, if the disk is not busy.
constexpr double most_unwatched_s = 5;
constexpr double same_deg = 1e-3;  // vam-print states four digits
constexpr double early_deg = 1;    // of the first image, at an angle that is predicted
constexpr double most_deg = 360 * FlipRules::most_turns;
constexpr double most_sealed_bytes = 1e15;
constexpr const char* changed = "; the log was changed; restore it";

std::string beside(const std::string& log, const char* name) {
  return (std::filesystem::path(log).parent_path() / name).string();
}

// A whole line: one that is cut has no end, and is not read.
Json entry_of(const std::string& text, const std::string& place) {
  Json entry = parse_distinct(text, place);
  if (!entry.is_object()) throw Error{Fault::data, place + ": is no entry of a log (JSON)" + changed};
  return entry;
}

double number_of(const Json& entry, const char* key, double low, double high, const std::string& place) {
  const double number = number_at(entry, key, std::numeric_limits<double>::quiet_NaN());
  if (number >= low && number <= high) return number;
  const std::string is = !entry.contains(key) ? "missing" : std::isnan(number) ? "no number" : format_number(number);
  throw Error{Fault::data, place + ": " + key + " is " + is + ", not between " + format_number(low) + " and " +
                               format_number(high) + changed};
}

// When the stage was last logged, by the log as it is now; none without whole lines.
std::optional<double> last_time(const std::string& angles) {
  constexpr std::streamoff tail_bytes = 65536;
  std::optional<double> last_s;
  LogLines lines(angles, tail_bytes);
  for (std::string text; lines.next(text);) last_s = number_at(entry_of(text, angles), "t_monotonic_s");
  return last_s;
}

bool is_hash(const std::string& text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

LogCrossCheck::LogCrossCheck(const std::string& log) : log_(log) {
  if (std::filesystem::path(log).filename() != "flips.jsonl" || !has_regular_file(beside(log, "events.jsonl"))) return;
  events_.emplace(beside(log, "events.jsonl"));
  angles_.emplace(beside(log, "angles.jsonl"));
}

void LogCrossCheck::read() {
  if (!events_) return;
  read_events();
  read_angles();
}

void LogCrossCheck::read_events() {
  for (std::string text; events_->next(text);) {
    const std::string place = beside(log_, "events.jsonl") + ":" + std::to_string(++event_);
    const Json event = entry_of(text, place);
    if (text_at(event, "event") == "armed") take_armed(event, place);
    if (text_at(event, "event") == "sealed" && text_at(event, "log") == "flips.jsonl") take_seal(event, place);
  }
}

void LogCrossCheck::take_armed(const Json& event, const std::string& place) {
  turns_ = number_of(event, "turns", 1, FlipRules::most_turns, place);
  from_deg_ = number_of(event, "from_deg", 0, 360 * turns_, place);
  sinogram_sha256_ = text_at(event, "sinogram_sha256");
}

void LogCrossCheck::require_armed(const Json& sinogram) const {
  if (!from_deg_) return;
  const auto differ = [this](const std::string& armed, const std::string& began) {
    throw Error{Fault::data, beside(log_, "events.jsonl") + ": states " + armed + ", but flips.jsonl " + began +
                                 "; it was changed; restore it"};
  };
  const double turns = number_at(sinogram, "turns", turns_);
  if (turns != turns_) differ(format_number(turns_) + " turns", format_number(turns));
  const double from_deg = number_at(sinogram, "from_deg", *from_deg_);
  if (!(std::abs(from_deg - *from_deg_) < same_deg))
    differ("light from " + format_number(*from_deg_, 8) + " deg", format_number(from_deg, 8));
  const std::string hash = text_at(sinogram, "sinogram_sha256");
  if (hash.empty() || sinogram_sha256_.empty() || hash == sinogram_sha256_) return;
  differ("a sinogram whose SHA-256 begins " + sinogram_sha256_.substr(0, 8), hash.substr(0, 8));
}

void LogCrossCheck::take_seal(const Json& event, const std::string& place) {
  const double bytes = number_of(event, "bytes", static_cast<double>(sealed_), most_sealed_bytes, place);
  Seal seal{static_cast<std::uint64_t>(bytes), text_at(event, "sha256"), text_at(event, "utc")};
  if (!is_hash(seal.sha256)) throw Error{Fault::data, place + ": sha256 is not 64 hexadecimal digits" + changed};
  sealed_ = seal.bytes;
  has_seals_ = true;
  if (seal.bytes > reached_) seals_.push_back(std::move(seal));  // else these lines were read before
}

void LogCrossCheck::read_angles() {
  for (std::string text; angles_->next(text);) {
    const std::string place = beside(log_, "angles.jsonl") + ":" + std::to_string(++angle_);
    const Json line = entry_of(text, place);
    last_s_ = number_of(line, "t_monotonic_s", 0, FlipRules::most_s, place);
    last_deg_ = number_of(line, "angle_deg", -most_deg, most_deg, place);
    if (!began_s_ && last_deg_ >= from_deg_.value_or(0)) began_s_ = last_s_;
  }
}

bool LogCrossCheck::check(std::uint64_t bytes, const Sha256& hash) {
  reached_ = bytes;
  bool is_sealed = false;
  while (problem_.empty() && !seals_.empty() && seals_.front().bytes <= bytes) {
    const Seal& seal = seals_.front();
    const std::string is = Sha256(hash).digest();
    if (seal.bytes < bytes) {
      problem_ = "has no line that ends at byte " + std::to_string(seal.bytes) +
                 ", where events.jsonl states one; it was changed; restore it";
    } else if (is != seal.sha256) {
      problem_ = "has " + std::to_string(bytes) + " bytes whose SHA-256 begins " + is.substr(0, 8) +
                 ", but events.jsonl states " + seal.sha256.substr(0, 8) + "; it was changed; restore it";
    }
    is_sealed = problem_.empty();
    seals_.pop_front();
  }
  return is_sealed;
}

std::string LogCrossCheck::last_angle() const {
  return "angles.jsonl, in which the stage turned on to " + format_number(last_deg_, 6) + " deg";
}

void LogCrossCheck::require_all(std::uint64_t bytes, const FlipsEnd& end) const {
  const auto require = [this](const std::string& problem) {
    if (!problem.empty()) throw Error{Fault::data, log_ + ": " + problem};
  };
  require(problem_);
  if (!seals_.empty()) {
    require("has " + std::to_string(bytes) + " bytes of whole lines, but events.jsonl states " +
            std::to_string(seals_.back().bytes) + " at " + seals_.back().utc + "; it was cut; restore it");
  }
  if (events_ && !has_seals_ && end.seals_since_s && end.t_s - *end.seals_since_s > most_unsealed_s) {
    throw Error{Fault::data,
                beside(log_, "events.jsonl") + ": has no seal of flips.jsonl, which was sealed every second for " +
                    format_number(end.t_s - *end.seals_since_s, 3) + " s; it was cut or changed; restore it"};
  }
  if (end.lit_deg && from_deg_ && *end.lit_deg < *from_deg_ - early_deg) {
    throw Error{Fault::data, beside(log_, "events.jsonl") + ": states light from " + format_number(*from_deg_, 8) +
                                 " deg, but flips.jsonl has some at " + format_number(*end.lit_deg, 8) +
                                 " deg; it was changed; restore it"};
  }
  require_angles(end);
  if (end.lit_s && !end.lit) return;  // the stage turns on in the dark
  const std::optional<double> until_s = end.lit_s ? std::optional(end.t_s) : began_s_;
  if (!until_s || !(last_s_ - *until_s > most_alone_s)) return;
  require((end.lit_s ? "ends " : "has no light, ") + format_number(last_s_ - *until_s, 3) + " s before " +
          last_angle() + "; it was cut; restore it");
}

// A print that goes on has both logs longer than when the angles were read.
void LogCrossCheck::require_angles(const FlipsEnd& end) const {
  if (!from_deg_ || !end.lit_s || *end.lit_s - last_s_ <= most_unwatched_s) return;
  const std::string angles = beside(log_, "angles.jsonl");
  const std::optional<double> until_s = last_time(angles);
  if (until_s && *end.lit_s - *until_s <= most_unwatched_s) return;
  const std::string problem = until_s ? "ends " + format_number(*end.lit_s - *until_s, 3) + " s before"
                              : has_regular_file(angles) ? "has no angle, but there is"
                                                         : "is gone, but there is";
  throw Error{Fault::data,
              angles + ": " + problem + " light in flips.jsonl, which follows the angles; it was cut; restore it"};
}

void LogCrossCheck::require_none() const {
  const auto gone = [this](const std::string& proof) {
    throw Error{Fault::data, log_ + ": is gone, but " + proof + "; restore it"};
  };
  if (has_seals_) gone("events.jsonl states " + std::to_string(sealed_) + " bytes of it");
  if (began_s_ && last_s_ - *began_s_ > most_alone_s)
    gone("the stage turned for " + format_number(last_s_ - *began_s_, 3) + " s with light, by " + last_angle());
}

void require_no_flips(const std::string& log) {
  LogCrossCheck proof(log);
  proof.read();
  proof.require_none();
}

}  // namespace vam::io

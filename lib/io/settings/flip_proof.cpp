// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/flip_proof.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/json_text.hpp"
#include "base/text.hpp"

namespace vam::io {

namespace {

// What a stage still turns when the projector's tool has ended: vam-print ends it within a second, or it ends by
// itself; and a power failure loses up to a second of flips.
constexpr double most_alone_s = 2;

std::string beside(const std::string& log, const char* name) {
  return (std::filesystem::path(log).parent_path() / name).string();
}

}  // namespace

FlipProof::FlipProof(const std::string& log) : log_(log) {
  if (std::filesystem::path(log).filename() != "flips.jsonl" || !has_regular_file(beside(log, "events.jsonl"))) return;
  events_.emplace(beside(log, "events.jsonl"));
  angles_.emplace(beside(log, "angles.jsonl"));
}

void FlipProof::read() {
  if (!events_) return;
  read_events();
  read_angles();
}

void FlipProof::read_events() {
  for (std::string text; events_->next(text);) {
    const Json event = parse_distinct(text, beside(log_, "events.jsonl"));
    if (!event.is_object()) continue;
    if (text_at(event, "event") == "armed") from_deg_ = number_at(event, "from_deg");
    if (text_at(event, "event") != "sealed" || text_at(event, "log") != "flips.jsonl") continue;
    const double bytes = number_at(event, "bytes", -1);
    if (!(bytes >= 0 && bytes < 1e15)) continue;
    seals_.push_back({static_cast<std::uint64_t>(bytes), text_at(event, "sha256"), text_at(event, "utc")});
  }
}

void FlipProof::read_angles() {
  for (std::string text; angles_->next(text);) {
    const Json line = parse_json(text);  // counts for nothing but its time
    if (!line.is_object() || !line.contains("angle_deg")) continue;
    last_s_ = number_at(line, "t_monotonic_s");
    last_deg_ = number_at(line, "angle_deg");
    if (!began_s_ && last_deg_ >= from_deg_.value_or(0)) began_s_ = last_s_;
  }
}

void FlipProof::check(std::uint64_t bytes, const Sha256& hash) {
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
    seals_.pop_front();
  }
}

void FlipProof::require_all(std::uint64_t bytes, const FlipsEnd& end) const {
  const auto require = [this](const std::string& problem) {
    if (!problem.empty()) throw Error{Fault::data, log_ + ": " + problem};
  };
  require(problem_);
  if (!seals_.empty()) {
    require("has " + std::to_string(bytes) + " bytes of whole lines, but events.jsonl states " +
            std::to_string(seals_.back().bytes) + " at " + seals_.back().utc + "; it was cut; restore it");
  }
  if (end.was_lit && !end.lit) return;  // the stage turns on in the dark
  const std::optional<double> until_s = end.was_lit ? std::optional(end.t_s) : began_s_;
  if (!until_s || !(last_s_ - *until_s > most_alone_s)) return;
  require((end.was_lit ? "ends " : "has no light, ") + format_number(last_s_ - *until_s, 3) +
          " s before angles.jsonl, in which the stage turned on to " + format_number(last_deg_, 6) +
          " deg; it was cut; restore it");
}

void require_no_flips(const std::string& log) {
  FlipProof proof(log);
  proof.read();
  proof.require_all(0, {});
}

}  // namespace vam::io

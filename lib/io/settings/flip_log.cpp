// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/flip_log.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr double last_run_up_deg = -360;  // from this angle on missed blanks are judged

// SHA-256 of the sinogram of a run folder; empty where it is not known.
std::string armed_sinogram(const std::string& run) {
  if (!std::filesystem::is_directory(run)) return "";
  LogLines events((std::filesystem::path(run) / "events.jsonl").string());
  for (Json event; events.next(event);) {
    if (event.contains("sinogram_sha256") && event["sinogram_sha256"].is_string()) return event["sinogram_sha256"];
  }
  return "";
}

std::string log_of(const std::string& run) {
  return std::filesystem::is_directory(run) ? (std::filesystem::path(run) / "flips.jsonl").string() : run;
}

// The hashes that a run states; none while there is no log.
std::set<std::string> hashes_of(const std::string& run) {
  std::set<std::string> hashes{armed_sinogram(run)};
  if (has_regular_file(log_of(run))) {
    FlipLog log(run);
    log.read();
    for (const ShownSinogram& one : log.sinograms()) hashes.insert(one.sha256);
  }
  hashes.erase("");
  return hashes;
}

// A print that has ended is held to the hash of its flips.
bool has_stated_hash(const std::string& run) {
  const auto stated = stated_flips(run);
  return stated && !stated->sha256.empty();
}

std::string beginnings(const std::set<std::string>& hashes) {
  std::vector<std::string> short_ones;
  for (const std::string& hash : hashes) short_ones.push_back(hash.substr(0, 8));
  return join(short_ones, ", ");
}

}  // namespace

FlipLog::FlipLog(const std::string& path)
    : file_(log_of(path)),
      lines_(file_),
      rules_(has_stated_hash(path) ? FlipRules::Order::free : FlipRules::Order::required) {
  if (!has_regular_file(file_)) {
    require_stated_flips(path);
    throw Error{Fault::no_input, file_ + ": cannot open: " + std::strerror(ENOENT)};
  }
  if (!has_stated_hash(path)) proof_.emplace(file_);
}

void FlipLog::read() {
  if (proof_) proof_->read();
  for (std::string text; lines_.next(text);) {
    ++line_;
    text.push_back('\n');
    hash_.add(text.data(), text.size());
    bytes_ += text.size();
    take(parse_distinct(text, place()));
    if (proof_ && proof_->check(bytes_, hash_)) sealed_ = count_of(flips_);
  }
  if (!proof_) return;
  FlipsEnd end{.seals_since_s = seals_since_s_};
  for (const RunFlip& flip : flips_) {
    end.lit = flip.frame >= 0;
    end.t_s = flip.t_s;
    if (!end.lit) continue;
    end.lit_s = flip.t_s;
    if (!end.lit_deg) end.lit_deg = flip.angle_deg;
  }
  proof_->require_all(bytes_, end);
}

std::string FlipLog::place() const { return file_ + ":" + std::to_string(line_); }

void FlipLog::take(const Json& event) {
  try {
    if (event.at("event") == "display") begin_run();
    if (event.at("event") == "sinogram" && proof_) proof_->require_armed(event);
    if (event.at("event") == "sinogram" || event.at("event") == "frames") {
      sinograms_.push_back({event.value("sinogram_sha256", ""), event.at("full_scale"), event.value("sinogram", "")});
      sinogram_ = count_of(sinograms_) - 1;
      if (event.at("event") == "frames" && event.contains("turns"))
        end_turn_ = event.at("turn").get<double>() + event.at("turns").get<double>();
      if (!seals_since_s_ && event.value("seals", false)) seals_since_s_ = event.at("t_monotonic_s").get<double>();
    }
    if (event.at("event") != "flip") return rules_.note(event, place());
    flips_.push_back({rules_.take(event, place()), false, sinogram_});
    if (flips_.back().angle_deg < last_run_up_deg) return;
    missed_ += flips_.back().missed;
    blanks_ += 1 + flips_.back().missed;
  } catch (const Json::exception&) {
    throw Error{Fault::data, place() + ": is not an event of a vam-project log"};
  }
}

void FlipLog::begin_run() {
  if (!flips_.empty()) flips_.back().last = true;
  sinogram_ = -1;
  end_turn_.reset();
}

template <class Counts>
std::vector<ShownImage> FlipLog::images(const Counts& counts) const {
  std::vector<ShownImage> shown;
  double before_s = 0;
  for (std::size_t i = 0; i < flips_.size(); ++i) {
    if (flips_[i].frame < 0 || (end_s_ && flips_[i].t_s >= *end_s_)) continue;
    const bool last = flips_[i].last || i + 1 == flips_.size();
    double seconds = !last ? std::max(0.0, flips_[i + 1].t_s - flips_[i].t_s) : before_s;
    before_s = seconds;
    if (end_s_) seconds = std::min(seconds, *end_s_ - flips_[i].t_s);
    if (counts(flips_[i])) shown.push_back({flips_[i].angle_deg, seconds});
  }
  if (end_s_ && !flips_.empty() && !flips_.back().last && counts(flips_.back())) extrapolate(before_s, shown);
  return shown;
}

// As a print that shows its last image does: from angle to angle at the pace that it had.
void FlipLog::extrapolate(double image_s, std::vector<ShownImage>& shown) const {
  if (flips_.size() < 2 || flips_.back().frame < 0 || flips_[flips_.size() - 2].frame < 0 || !(image_s > 0)) return;
  const double step_deg = flips_.back().angle_deg - flips_[flips_.size() - 2].angle_deg;
  double angle_deg = flips_.back().angle_deg;
  double t_s = flips_.back().t_s + image_s;
  constexpr double most_images = 1e7;  // two days at 60 Hz
  if (const double images = (*end_s_ - t_s) / image_s; images > most_images) {
    throw Error{Fault::data, file_ + ": the light would go on for " + format_number(images, 3) +
                                 " images to the time at which it is to end; give an earlier one"};
  }
  while (t_s < *end_s_) {
    angle_deg += step_deg;
    shown.push_back({angle_deg, std::min(image_s, *end_s_ - t_s)});
    t_s += image_s;
  }
}

long FlipLog::lit() const {
  return std::count_if(flips_.begin(), flips_.end(), [](const RunFlip& flip) { return flip.frame >= 0; });
}

std::string FlipLog::seals_text() const {
  if (!sealed_) return "";
  const int all = count_of(flips_);
  return "sealed up to flip " + std::to_string(*sealed_) + " of " + std::to_string(all) +
         (*sealed_ < all ? "; unsealed after it: " + std::to_string(all - *sealed_) : "");
}

std::string FlipLog::sha256() const { return Sha256(hash_).digest(); }

void FlipLog::truncate_at(double t_monotonic_s) { end_s_ = t_monotonic_s; }

std::vector<ShownImage> FlipLog::shown() const {
  return images([](const RunFlip&) { return true; });
}

std::vector<ShownImage> FlipLog::shown_of(const std::string& sha256) const {
  const auto is_it = [&](const ShownSinogram& one) { return !one.sha256.empty() && one.sha256 == sha256; };
  const bool stated = std::any_of(sinograms_.begin(), sinograms_.end(), is_it);
  return images([&](const RunFlip& flip) {
    const bool is_unknown = flip.sinogram < 0 || sinograms_[flip.sinogram].sha256.empty();
    return is_unknown ? !stated : is_it(sinograms_[flip.sinogram]);
  });
}

std::optional<FlipSummary> stated_flips(const std::string& run) {
  const std::filesystem::path log(log_of(run));
  const std::string file = (log.parent_path() / "summary.json").string();
  if (log.filename() != "flips.jsonl" || !has_regular_file(file)) return std::nullopt;
  constexpr std::uint64_t most_bytes = std::uint64_t{64} << 20U;
  const Json summary = parse_distinct(read_all(file, Content::text, most_bytes), file);
  if (!is_of(summary, "vam-print")) return std::nullopt;  // being written
  FlipSummary stated;
  const Json reached = summary.value("reached", Json());
  if (reached.is_object() && reached.value("lit_flips", Json()).is_number_integer()) stated.lit = reached["lit_flips"];
  if (const Json hash = summary.value("flips_sha256", Json()); hash.is_string()) stated.sha256 = hash;
  return stated;
}

std::optional<std::string> logged_outcome(const std::string& run) {
  std::optional<std::string> outcome;
  LogLines events((std::filesystem::path(run) / "events.jsonl").string());
  for (Json event; events.next(event);) {
    if (text_at(event, "event") == "end") outcome = text_at(event, "outcome", "unknown");
  }
  return outcome;
}

void require_stated_flips(const std::string& run, const std::optional<FlipSummary>& stated, long lit,
                          const std::string& sha256) {
  if (!stated) return;
  constexpr const char* remedy = "; it was cut or changed; restore it";
  if (stated->lit && *stated->lit != lit) {
    throw Error{Fault::data, log_of(run) + ": has " + std::to_string(lit) + " lit flips, but summary.json states " +
                                 std::to_string(*stated->lit) + remedy};
  }
  if (stated->sha256.empty() || stated->sha256 == sha256) return;
  throw Error{Fault::data, log_of(run) + ": has lines whose SHA-256 begins " + sha256.substr(0, 8) +
                               ", but summary.json states " + stated->sha256.substr(0, 8) + remedy};
}

void require_stated_flips(const std::string& run) {
  const auto stated = stated_flips(run);
  if (!has_regular_file(log_of(run))) {
    require_stated_flips(run, stated, 0, vam::sha256(""));
    return require_no_flips(log_of(run));
  }
  FlipLog log(run);
  log.read();
  require_stated_flips(run, stated, log.lit(), log.sha256());
}

DisplayHistory read_showing(const std::string& run, const std::string& sinogram, std::optional<double> before_s) {
  require_sinogram_of(run, sinogram);
  const auto stated_log = stated_flips(run);
  FlipLog log(run);
  log.read();
  require_stated_flips(run, stated_log, log.lit(), log.sha256());
  if (before_s) log.truncate_at(*before_s);
  const std::string given = sinogram == "-" ? "" : sha256_of(sinogram);
  DisplayHistory showing{sinogram == "-" ? log.shown() : log.shown_of(given)};
  const std::vector<ShownSinogram>& all = log.sinograms();
  const bool stated = !given.empty() && std::any_of(all.begin(), all.end(),
                                                    [&](const ShownSinogram& one) { return one.sha256 == given; });
  for (const ShownSinogram& one : all) {
    if (sinogram != "-" && one.sha256 != (stated ? given : "")) continue;
    constexpr double same = 1e-6;
    if (showing.full_scale > 0 && std::abs(one.full_scale / showing.full_scale - 1) > same) {
      throw Error{Fault::data, run + ": showed " + sinogram + " at full scales of " +
                                   format_number(showing.full_scale) + " and " + format_number(one.full_scale) +
                                   "; give each run a log of its own"};
    }
    showing.full_scale = one.full_scale;
  }
  return showing;
}

bool states_sinogram(const std::string& run) { return !hashes_of(run).empty(); }

void require_sinogram_of(const std::string& run, const std::string& sinogram) {
  const std::set<std::string> hashes = hashes_of(run);
  if (hashes.empty() || (sinogram == "-" && hashes.size() == 1)) return;
  if (sinogram == "-") {
    throw Error{Fault::data, run + ": showed " + std::to_string(hashes.size()) +
                                 " sinograms one after the other; give one of them as a file"};
  }
  if (hashes.count(sha256_of(sinogram)) > 0) return;
  throw Error{Fault::data, sinogram + ": is " +
                               (hashes.size() == 1 ? "not the sinogram of " + run + ", whose SHA-256 begins "
                                                   : "none of the sinograms of " + run + ", whose SHA-256 begin ") +
                               beginnings(hashes) + "; give one that was shown"};
}

std::vector<double> turns_shown(const std::vector<ShownImage>& shown, const StageRows& rows, double speed_deg_s) {
  std::vector<double> turns(rows.count);
  const double row_s = 360.0 / rows.count / speed_deg_s;
  for (const ShownImage& image : shown) {
    const long nearest = std::lround((image.angle_deg - rows.start_deg) / rows.step_deg) % rows.count;
    turns[nearest < 0 ? nearest + rows.count : nearest] += image.seconds / row_s;
  }
  return turns;
}

}  // namespace vam::io

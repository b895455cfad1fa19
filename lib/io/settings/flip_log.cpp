// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/flip_log.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>
#include <string_view>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/settings/run_folder.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr double last_run_up_deg = -360;  // from this angle on missed blanks are judged

bool is_lit(const LoggedFlip& flip) { return flip.frame >= 0; }

std::string log_of(const std::string& run) {
  return std::filesystem::is_directory(run) ? (std::filesystem::path(run) / "flips.jsonl").string() : run;
}

// The hashes that a run states; none while there is no log.
std::set<std::string> hashes_of(const std::string& run) {
  std::set<std::string> hashes;
  if (std::filesystem::is_directory(run)) hashes.insert(read_events(run).sinogram_sha256);
  if (has_regular_file(log_of(run))) {
    FlipLog log(run);
    log.read();
    for (const ShownSinogram& one : log.sinograms()) hashes.insert(one.sha256);
  }
  hashes.erase("");
  return hashes;
}

int whole_at(const Json& event, const char* key, const std::string& place) {
  constexpr int most = 100000000;  // frames, and blanks of 100 Hz in 11 days
  const int least = std::string_view(key) == "frame" ? -1 : 0;
  const Json& value = event.at(key);
  const double number = value.is_number_integer() ? value.get<double>() : -2;
  if (number >= least && number <= most) return static_cast<int>(number);
  throw Error{Fault::data, place + ": " + key + " " + briefly(value.dump()) + " is not a whole number from " +
                               std::to_string(least) + " to " + std::to_string(most) +
                               "; the log was changed; restore it"};
}

std::string beginnings(const std::set<std::string>& hashes) {
  std::vector<std::string> short_ones;
  for (const std::string& hash : hashes) short_ones.push_back(hash.substr(0, 8));
  return join(short_ones, ", ");
}

}  // namespace

FlipLog::FlipLog(const std::string& path) : file_(log_of(path)), lines_(file_) {
  if (!has_regular_file(file_)) throw Error{Fault::no_input, file_ + ": cannot open: " + std::strerror(ENOENT)};
}

void FlipLog::read() {
  for (std::string text; lines_.next(text);) take(parse_distinct(text, lines_.place()));
}

void FlipLog::take(const Json& event) {
  try {
    const std::string name = event.at("event");
    if (name == "display") begin_run();
    if (name == "sinogram") {
      frames_ = event.value("frames", 0L);
      turns_ = event.value("turns", 0.0);
    }
    if (name == "sinogram" || name == "frames") {
      sinograms_.push_back({event.value("sinogram_sha256", ""), event.at("full_scale"), event.value("sinogram", "")});
      sinogram_ = count_of(sinograms_) - 1;
      if (name == "frames" && event.contains("turns"))
        end_turn_ = event.at("turn").get<double>() + event.at("turns").get<double>();
    }
    if (name == "flip") take_flip(event);
  } catch (const Json::exception&) {
    throw Error{Fault::data, lines_.place() + ": is not an event of a vam-project log"};
  }
}

void FlipLog::take_flip(const Json& event) {
  const LoggedFlip flip{event.at("t_monotonic_s"), whole_at(event, "frame", lines_.place()), event.at("angle_deg"),
                        event.contains("missed") ? whole_at(event, "missed", lines_.place()) : 0};
  require_possible(flip);
  flips_.push_back(flip);
  places_.push_back({false, sinogram_});
  if (flip.angle_deg < last_run_up_deg) return;
  missed_ += flip.missed;
  blanks_ += 1 + flip.missed;
}

void FlipLog::require_possible(const LoggedFlip& flip) const {
  constexpr double most_s = 1e9;      // 30 years since the machine started
  constexpr double most_turns = 1e6;  // as of stage.turns
  const bool lit = flip.frame >= 0;
  const double least_deg = lit ? 0 : -360 * most_turns;
  const double most_deg = 360 * (lit && turns_ > 0 ? turns_ : most_turns);
  const auto refuse = [&](const std::string& problem) {
    throw Error{Fault::data, lines_.place() + ": " + problem + "; the log was changed; restore it"};
  };
  if (!(flip.t_s >= 0 && flip.t_s <= most_s)) {
    refuse("time " + format_number(flip.t_s) + " s is not between 0 and " + format_number(most_s) +
           " s since the machine started");
  }
  if (!flips_.empty() && !places_.back().last && flip.t_s < flips_.back().t_s)
    refuse("time " + format_number(flip.t_s, 12) + " s is before that of the flip before it");
  if (frames_ > 0 && flip.frame >= frames_)
    refuse("frame " + std::to_string(flip.frame) + " is none of the " + std::to_string(frames_) + " of the print");
  if (flip.angle_deg >= least_deg && flip.angle_deg <= most_deg) return;
  refuse("angle " + format_number(flip.angle_deg) + " deg is not between " + format_number(least_deg) + " and " +
         format_number(most_deg) + " deg" + (lit ? ", where images are shown" : ""));
}

void FlipLog::begin_run() {
  if (!places_.empty()) places_.back().last = true;
  frames_ = 0;
  turns_ = 0;
  sinogram_ = -1;
  end_turn_.reset();
}

template <class Counts>
std::vector<ShownImage> FlipLog::images(const Counts& counts) const {
  std::vector<ShownImage> shown;
  double before_s = 0;
  for (std::size_t i = 0; i < flips_.size(); ++i) {
    if (flips_[i].frame < 0 || (end_s_ && flips_[i].t_s >= *end_s_)) continue;
    const bool last = places_[i].last || i + 1 == flips_.size();
    double seconds = !last ? std::max(0.0, flips_[i + 1].t_s - flips_[i].t_s) : before_s;
    before_s = seconds;
    if (end_s_) seconds = std::min(seconds, *end_s_ - flips_[i].t_s);
    if (counts(places_[i])) shown.push_back({flips_[i].angle_deg, seconds});
  }
  if (end_s_ && !flips_.empty() && !places_.back().last && counts(places_.back())) extrapolate(before_s, shown);
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

long FlipLog::lit() const { return std::count_if(flips_.begin(), flips_.end(), is_lit); }

const LoggedFlip* FlipLog::last_lit() const {
  const auto last = std::find_if(flips_.rbegin(), flips_.rend(), is_lit);
  return last == flips_.rend() ? nullptr : &*last;
}

void FlipLog::truncate_at(double t_monotonic_s) { end_s_ = t_monotonic_s; }

std::vector<ShownImage> FlipLog::shown() const {
  return images([](const RunPlace&) { return true; });
}

std::vector<ShownImage> FlipLog::shown_of(const std::string& sha256) const {
  const auto is_it = [&](const ShownSinogram& one) { return !one.sha256.empty() && one.sha256 == sha256; };
  const bool stated = std::any_of(sinograms_.begin(), sinograms_.end(), is_it);
  return images([&](const RunPlace& at) {
    const bool is_unknown = at.sinogram < 0 || sinograms_[at.sinogram].sha256.empty();
    return is_unknown ? !stated : is_it(sinograms_[at.sinogram]);
  });
}

DisplayHistory read_showing(const std::string& run, const std::string& sinogram, std::optional<double> before_s) {
  require_sinogram_of(run, sinogram);
  FlipLog log(run);
  log.read();
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

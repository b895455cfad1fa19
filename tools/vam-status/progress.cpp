// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-status/progress.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/run_folder.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/stream.hpp"

namespace vam::status_tool {

namespace {

namespace fs = std::filesystem;

constexpr double silence_s = 5;               // longer than any pause of a stage that turns
constexpr double loading_s = 600;             // and than it takes to load frames and to find a reference
constexpr std::streamoff tail_bytes = 65536;  // holds many entries

// Time to the planned end; infinite where it is not known or light has not begun.
double left_s(const PrintProgress& p, double speed_deg_s) {
  if (p.blanks == 0 || !(p.turns > 0) || !(speed_deg_s > 0)) return std::numeric_limits<double>::infinity();
  return std::max(0.0, 360 * p.turns - p.angle_deg) / speed_deg_s;
}

// vam-print writes these before it is armed; a printer file with more beside it is a user's own.
bool about_to_be_armed(const RunFolder& run) {
  if (has_regular_file(run.file("calibration.json"))) return true;
  const std::string settings = run.file("printer.toml");
  return has_regular_file(settings) && io::require_text_seal(io::read_all(settings), settings);
}

}  // namespace

RunFolder::RunFolder(const std::string& path) : path_(path) {
  io::require_run(path);
  if (!has_regular_file(file("events.jsonl")) && !about_to_be_armed(*this)) {
    throw Error{Fault::data, path + ": has no events.jsonl; give the run folder of a print that vam-print has armed"};
  }
  load_settings();
}

void RunFolder::load_settings() {
  if (settled_ || !has_regular_file(file("printer.toml"))) return;
  printer_ = io::load_printer(file("printer.toml"), {}, io::Records::ignore);
  settled_ = true;
}

std::string RunFolder::file(const std::string& name) const { return (fs::path(path_) / name).string(); }

std::vector<io::ShownImage> RunFolder::shown() const {
  if (!flips_) return {};
  return flips_->sinograms().empty() ? flips_->shown() : flips_->shown_of(flips_->sinograms().front().sha256);
}

bool RunFolder::renewed() const { return flips_ && flips_->sinograms().size() > 1; }

void RunFolder::read() {
  load_settings();
  read_events();
  read_angle();
  read_flips();
  if (!settled_ && !progress_.outcome) io::require_run_settings(path_);
  look_for_end();
  progress_.resumed_by = io::resumed_by(path_);
  read_records();
  LogLines figures(file("ost.jsonl"), tail_bytes);
  for (Json line; figures.next(line);) {
    if (line.contains("missing_percent")) progress_.missing_percent = number_at(line, "missing_percent", 0);
  }
}

void RunFolder::read_events() {
  progress_.silent_s = 1e9;
  // Before, there are only the settings.
  const bool armed = has_regular_file(file("events.jsonl")) && fs::file_size(file("events.jsonl")) > 0;
  held_ = armed ? std::optional(io::is_printed(path_)) : std::nullopt;  // before the end is looked for
  for (const char* name :
       {armed ? "events.jsonl" : "printer.toml", armed ? "flips.jsonl" : "calibration.json", "angles.jsonl"}) {
    std::error_code problem;
    const auto written = fs::last_write_time(file(name), problem);
    if (problem) continue;
    const std::chrono::duration<double> age = fs::file_time_type::clock::now() - written;
    progress_.silent_s = std::min(progress_.silent_s, std::max(0.0, age.count()));
  }
  const io::RunEvents events = io::read_events(path_);
  if (events.turns > 0) progress_.turns = events.turns;
  progress_.from_deg = events.from_deg;
  if (events.outcome) {
    progress_.outcome = events.outcome;
    progress_.status = events.status;
  }
  if (!progress_.outcome) read_summary();
  progress_.simulated.clear();
  for (const io::UsedDevice& one : io::used_devices(path_)) {
    if (one.simulated) progress_.simulated.push_back(one.what == "light" ? "light engine" : one.what);
  }
}

// The last that vam-print writes: a print that has it has ended, whatever became of its events.
void RunFolder::read_summary() {
  if (!has_regular_file(file("summary.json"))) return;
  constexpr std::uint64_t most_bytes = std::uint64_t{64} << 20U;
  const Json summary =
      parse_distinct(io::read_all(file("summary.json"), io::Content::text, most_bytes), file("summary.json"));
  if (!summary.is_object() || text_at(summary, "outcome").empty()) return;  // one that is being written
  progress_.outcome = text_at(summary, "outcome");
  progress_.status = static_cast<int>(number_at(summary, "status", 0));
  if (progress_.turns == 0) progress_.turns = number_at(summary, "turns", 0);
  warn(file("events.jsonl") + ": does not tell of the end that summary.json states; it was cut or changed; restore it");
}

void RunFolder::read_angle() {
  LogLines angles(file("angles.jsonl"), tail_bytes);
  for (Json line; angles.next(line);) progress_.angle_deg = number_at(line, "angle_deg", progress_.angle_deg);
}

void RunFolder::read_flips() {
  if (progress_.turns > 0 && settled_) progress_.given_fraction = 0;
  if (!flips_ && !has_regular_file(file("flips.jsonl"))) return;
  if (!flips_) flips_.emplace(path_);
  flips_->read();
  progress_.missed = flips_->missed();
  progress_.blanks = flips_->blanks();
  if (const auto shown = flips_->shown(); !shown.empty()) {  // angles.jsonl may be cut
    progress_.angle_deg = std::max(progress_.angle_deg, shown.back().angle_deg);
  }
  if (flips_->end_turn()) progress_.turns = std::min(progress_.turns, *flips_->end_turn());
  double lit_s = 0;
  for (const io::ShownImage& image : flips_->shown()) lit_s += image.seconds;
  const double wanted_deg = 360 * progress_.turns - progress_.from_deg;
  if (settled_ && progress_.turns > 0 && wanted_deg > 0)
    progress_.given_fraction = std::min(1.0, lit_s * printer_.stage.speed_deg_s / wanted_deg);
}

// Whoever prints holds the events. Without them, as they were lost, the other logs tell; times of files may be those of
// another clock, but nothing follows the last angle.
void RunFolder::look_for_end() {
  const bool is_over = left_s(progress_, printer_.stage.speed_deg_s) < 0.5;
  const bool is_alive = held_.value_or(progress_.blanks == 0);
  progress_.abandoned = !progress_.outcome && !is_alive && (held_ || is_over || progress_.silent_s > silence_s);
  if (is_alive || warned_ || !(progress_.outcome || progress_.abandoned) || io::has_run_sums(path_)) return;
  warned_ = true;
  const std::string sealed = io::sealed_flips(path_);
  warn(path_ + ": has no SHA256SUMS, which a print writes when it has ended: it was killed, or the list is gone; " +
       (sealed.empty() ? "its logs are not verified" : "only its logs are verified: " + sealed));
}

void RunFolder::read_records() {
  progress_.records.clear();
  if (!has_regular_file(file("calibration.json"))) return;
  constexpr std::uint64_t most_bytes = 1U << 20U;
  const Json records =
      parse_distinct(io::read_all(file("calibration.json"), io::Content::text, most_bytes), file("calibration.json"));
  if (!records.is_object()) return;
  for (const auto& [scan, record] : records.items()) {
    if (!record.is_object()) continue;
    progress_.records.push_back(
        {scan, text_at(record, "utc"), text_at(record, "valid_until"), text_at(record, "status")});
  }
}

std::string state_of(const PrintProgress& progress) {
  if (progress.outcome) return "ended: " + printable(*progress.outcome);
  const bool silent = progress.silent_s > (progress.blanks > 0 ? silence_s : loading_s);
  if (progress.abandoned && progress.silent_s <= silence_s) return "end not logged";
  if (progress.abandoned || silent) {
    return "no log entry for " + std::to_string(std::lround(progress.silent_s)) + " s; end not logged";
  }
  if (progress.blanks == 0) return "preparing";
  return progress.angle_deg < progress.from_deg ? "run-up, dark" : "printing";
}

std::string turn_text(const PrintProgress& p) {
  // Neither is known of a print that is not armed, or whose events.jsonl is cut.
  if (p.turns <= 0) return fixed_number(std::max(0.0, p.angle_deg / 360), 2) + " of unknown";
  return fixed_number(std::clamp(p.angle_deg / 360, 0.0, p.turns), 2) + " of " + format_number(p.turns);
}

std::string angle_text(const PrintProgress& p) {
  return fixed_number(std::fmod(std::fmod(p.angle_deg, 360) + 360, 360), 1) + " deg";
}

std::string given_text(const PrintProgress& p) {
  return p.given_fraction ? fixed_number(100 * *p.given_fraction, 1) + " %" : "unknown";
}

std::string status_line(const PrintProgress& p, double speed_deg_s) {
  std::string line = state_of(p) + "  turn " + turn_text(p) + "  angle " + angle_text(p) + "  dose delivered " +
                     given_text(p) + "  missed " + std::to_string(p.missed) + " of " + std::to_string(p.blanks) +
                     " vertical blanks";
  if (p.missing_percent) {
    line += "  cured " + fixed_number(100 - *p.missing_percent, 1) + " %, missing " +
            fixed_number(*p.missing_percent, 1) + " %";
  }
  if (const double left = left_s(p, speed_deg_s);
      !p.outcome && !p.abandoned && p.silent_s <= silence_s && std::isfinite(left)) {
    const long seconds = std::lround(left);
    line +=
        "  " + std::to_string(seconds / 60) + (seconds % 60 < 10 ? ":0" : ":") + std::to_string(seconds % 60) + " left";
  }
  if (!p.resumed_by.empty()) line += "  resumed by " + excerpt(p.resumed_by);
  return line;
}

}  // namespace vam::status_tool

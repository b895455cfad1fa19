// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "io/settings/run_folder.hpp"
#include "io/stream/stream.hpp"
#include "vam-print/run.hpp"

namespace vam::print_tool {

namespace {

namespace fs = std::filesystem;

// Of a log, those that have this in their text.
std::vector<Json> entries(const std::string& file, const std::string& words) {
  std::vector<Json> found;
  for (const std::string& line : split(text_of(file), '\n')) {
    if (line.find(words) == std::string::npos) continue;
    if (Json entry = parse_json(line); entry.is_object()) found.push_back(std::move(entry));
  }
  return found;
}

long count_of(const std::string& file, const std::string& event) {
  return std::ssize(entries(file, "\"event\":\"" + event + "\""));
}

Json simulated(const Run& run) {
  const std::vector<io::UsedDevice> used = io::used_devices(run.folder);
  Json devices = Json::array();
  for (const char* what : {"stage", "camera", "light"}) {
    const auto is_it = [&](const io::UsedDevice& one) { return one.what == what && one.simulated; };
    if (std::any_of(used.begin(), used.end(), is_it)) devices.push_back(what);
  }
  return devices;
}

// As far as the last image.
Json reached(const Run& run) {
  const double lit_deg = run.light->last_lit() != nullptr ? run.light->last_lit()->angle_deg : 0;
  constexpr double digits = 1e4;
  const std::vector<Json> figures = entries(run.file("ost.jsonl"), "\"missing_percent\"");
  return {{"turns", std::round(lit_deg / 360 * digits) / digits},
          {"lit_flips", run.light->lit()},
          {"missed_flips", run.light->missed()},
          {"figures", figures.empty() ? Json() : figures.back()}};
}

Json embedded(const Run& run, const char* name) {
  const Json value = parse_json(text_of(run.file(name)));
  return value.is_discarded() ? Json() : value;
}

Json facts_of(const Run& run, int status) {
  Json statuses = Json::object();
  for (const auto& [name, ended] : run.statuses) statuses[name] = ended;
  Json facts{{"schema", FormatKind("vam-print").schema()},
             {"begun", run.begun},
             {"ended", utc_text(utc_seconds())},
             {"outcome", run.outcome},
             {"status", status},
             {"turns", run.turns},
             {"simulated", simulated(run)},
             {"reached", run.light ? reached(run) : Json()},
             {"sinogram_sha256", run.sinogram_sha256},
             {"exit_statuses", statuses}};
  if (run.options.correct) {
    const std::string log = run.file("renewed.jsonl");
    facts["correction"] = {{"renewed", count_of(log, "renewed")},
                           {"held", count_of(log, "hold")},
                           {"open_loop_from", run.open_loop_from ? Json(*run.open_loop_from) : Json()}};
  }
  for (const auto& [key, file] : {std::pair{"calibration", "calibration.json"},
                                  {"project", "project.json"},
                                  {"capture", "capture.json"},
                                  {"stop_event", "stop.json"}}) {
    facts[key] = embedded(run, file);
  }
  return facts;
}

// A line for each key.
std::string lines_of(const Json& facts) {
  std::vector<std::string> lines;
  for (const auto& [key, value] : facts.items()) {
    lines.push_back("\"" + key + "\": " + value.dump(-1, ' ', false, Json::error_handler_t::replace));
  }
  return "{" + join(lines, ",\n ") + "}\n";
}

std::string sums_of(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (entry.is_regular_file() && !entry.is_symlink() && name != "SHA256SUMS") names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  std::string text;
  for (const std::string& name : names) text += io::sha256_of(folder + "/" + name) + "  ./" + name + "\n";
  return text;
}

}  // namespace

bool is_used(const Run& run) {
  const auto has = [&](const char* name) { return !text_of(run.file(name)).empty(); };
  return has("stage.jsonl") || has("capture.jsonl") || (run.light && !run.light->flips().empty());
}

void log_dark(const Run& run) {
  if (!run.dark_s || !run.light || run.light->flips().empty() || run.light->flips().back().frame < 0) return;
  const io::LoggedFlip& last = run.light->flips().back();
  std::error_code ignored;
  fs::remove(run.file(".reserve"), ignored);
  const double on_s = std::max(0.0, *run.dark_s - last.t_s);
  const double turned_deg = run.printer.stage.speed_deg_s * on_s;
  try {
    device::EventLog(run.file("flips.jsonl"))
        .at(last.t_s + on_s, "flip", {{"frame", -1}, {"angle_deg", last.angle_deg + turned_deg}, {"by", "vam-print"}});
  } catch (const Error&) {
    // The disk is full, which is reported.
  }
  constexpr double noticed_s = 0.1;
  if (on_s <= noticed_s) return;
  say("warning: the last image stayed on for " + fixed_number(on_s, 2) + " s, while the stage turned by " +
      fixed_number(turned_deg, 0) + " deg; vam-dose --shown counts this light at the angle where it began");
}

void write_summary(const Run& run, int status) {
  std::error_code ignored;
  fs::remove(run.file(".reserve"), ignored);
  run.talk.keep(run.folder);
  for (const char* pipe : pipes) fs::remove(run.file(pipe), ignored);
  io::write_text(run.file("summary.json"), lines_of(facts_of(run, status)));
  io::write_text(run.file("SHA256SUMS"), sums_of(run.folder));  // whoever finds the list finds all of it
}

}  // namespace vam::print_tool

// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-print/summary.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/log/log.hpp"
#include "base/sha256.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "base/text/utc.hpp"
#include "io/stream/stream.hpp"
#include "vam-print/commands.hpp"

namespace vam::print_tool {

namespace {

namespace fs = std::filesystem;

// The last lines of a log that have this, as JSON; discarded where there is none.
Json last_with(const std::string& file, const std::string& words) {
  Json last;
  for (const std::string& line : split(text_of(file), '\n')) {
    if (line.find(words) != std::string::npos) last = parse_json(line);
  }
  return last.is_discarded() ? Json() : last;
}

long count_of(const std::string& file, const std::string& event) {
  long count = 0;
  for (const std::string& line : split(text_of(file), '\n')) count += text_at(parse_json(line), "event") == event;
  return count;
}

bool is_simulated(const std::string& file, const std::string& event) {
  const auto lines = split(text_of(file), '\n');
  return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) {
    return line.find("\"simulated\":true") != std::string::npos && text_at(parse_json(line), "event") == event;
  });
}

Json simulated(const Run& run) {
  Json devices = Json::array();
  if (is_simulated(run.file("stage.jsonl"), "begin")) devices.push_back("stage");
  if (is_simulated(run.file("capture.jsonl"), "begin")) devices.push_back("camera");
  if (is_simulated(run.file("flips.jsonl"), "light")) devices.push_back("light");
  return devices;
}

// Of whole lines; a line that was cut counts for no reader.
std::string flips_hash(const Run& run) {
  std::string text = text_of(run.file("flips.jsonl"));
  text.resize(text.rfind('\n') + 1);  // npos + 1: none
  return sha256(text);
}

Json embedded(const Run& run, const char* name) {
  const Json value = parse_json(text_of(run.file(name)));
  return value.is_discarded() ? Json() : value;
}

Json facts_of(const Run& run, const ShownLight& light, int status) {
  Json reached;
  if (fs::exists(run.file("flips.jsonl"))) {
    reached = light.reached();
    reached["figures"] = last_with(run.file("ost.jsonl"), "\"missing_percent\"");
  }
  Json statuses = Json::object();
  for (const auto& [name, ended] : run.statuses) statuses[name] = ended;
  Json facts{{"schema", FormatKind("vam-print").schema()},
             {"begun", run.begun},
             {"ended", utc_text(utc_seconds())},
             {"outcome", run.outcome},
             {"status", status},
             {"turns", run.turns},
             {"simulated", simulated(run)},
             {"reached", reached},
             {"flips_sha256", flips_hash(run)},
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

bool is_used(const Run& run, const ShownLight& light) {
  const auto has = [&](const char* name) { return !text_of(run.file(name)).empty(); };
  return has("stage.jsonl") || has("capture.jsonl") || light.any();
}

void log_dark(const Run& run, const ShownLight& light) {
  const auto& last = light.last();
  const std::string file = run.file("flips.jsonl");
  if (!run.dark_s || !last || last->frame < 0 || !text_of(file).ends_with('\n')) return;
  std::error_code ignored;
  fs::remove(run.file(".reserve"), ignored);
  const double on_s = std::max(0.0, *run.dark_s - last->t_s);
  const double turned_deg = run.printer.stage.speed_deg_s * on_s;
  const Json flip{{"utc", utc_text(utc_seconds())},
                  {"t_monotonic_s", last->t_s + on_s},
                  {"event", "flip"},
                  {"frame", -1},
                  {"angle_deg", last->angle_deg + turned_deg},
                  {"by", "vam-print"}};
  std::ofstream(file, std::ios::app) << flip.dump() + "\n";
  constexpr double noticed_s = 0.1;
  if (on_s <= noticed_s) return;
  say("warning: the last image stayed on for " + fixed_number(on_s, 2) + " s, while the stage turned by " +
      fixed_number(turned_deg, 0) + " deg; vam-dose --shown counts this light at the angle where it began");
}

void write_summary(const Run& run, const ShownLight& light, int status) {
  std::error_code ignored;
  fs::remove(run.file(".reserve"), ignored);
  run.talk.keep(run.folder);
  for (const char* pipe : pipes) fs::remove(run.file(pipe), ignored);
  io::write_text(run.file("summary.json"), lines_of(facts_of(run, light, status)));
  io::write_text(run.file("SHA256SUMS"), sums_of(run.folder));  // whoever finds the list finds all of it
}

}  // namespace vam::print_tool

// SPDX-License-Identifier: GPL-3.0-or-later
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

#include "base/error.hpp"
#include "base/log/chain.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/text.hpp"
#include "io/settings/flip_log.hpp"
#include "io/settings/run_folder.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr const char* flips_log = "flips.jsonl";

std::string log_path(const std::string& run, const std::string& name) {
  return (std::filesystem::path(run) / name).string();
}

void take_event(const Json& event, RunEvents& events) {
  const std::string name = text_at(event, "event");
  if (name == "armed") {
    events.turns = number_at(event, "turns");
    events.from_deg = number_at(event, "from_deg");
    events.armed_utc = text_at(event, "utc");
    events.sinogram_sha256 = text_at(event, "sinogram_sha256");
    events.resumes = text_at(event, "resumes");
    events.resumes_utc = text_at(event, "resumes_utc");
  }
  if (name == "resumed") events.resumed_by = text_at(event, "by", "another print");
  if (name == "released") events.resumed_by = "";
  if (name == "end") {
    events.outcome = text_at(event, "outcome", "unknown");
    events.status = static_cast<int>(number_at(event, "status"));
    events.ended_utc = text_at(event, "utc");
  }
  if (name != "sealed" || !event.contains("logs") || !event["logs"].is_object()) return;
  for (const auto& [log, stated] : event["logs"].items()) {
    events.logs[log] = {static_cast<std::uint64_t>(number_at(stated, "bytes")), text_at(stated, "chain"),
                        text_at(event, "utc")};
  }
}

// Of a log that may grow meanwhile.
void require_log(const std::string& path, const RunEvents::Log& stated) {
  const std::string much = std::to_string(stated.bytes);
  if (stated.bytes > 0 && !has_regular_file(path))
    throw Error{Fault::data, path + ": is gone, but events.jsonl states " + much + " bytes of it; restore it"};
  std::uint64_t bytes = 0;
  bool is_there = stated.bytes == 0;
  LogLines lines(path);
  for (std::string line; lines.next(line);) {
    bytes += line.size() + 1;
    if (bytes == stated.bytes) is_there = chain_of(line) == stated.chain;
  }
  if (bytes < stated.bytes) {
    throw Error{Fault::data, path + ": has " + std::to_string(bytes) +
                                 " bytes of whole lines, but events.jsonl states " + much + " at " + stated.utc +
                                 "; it was cut; restore it"};
  }
  if (is_there) return;
  throw Error{Fault::data, path + ": has at byte " + much + " another line than events.jsonl states (chain " +
                               stated.chain + "); it was changed; restore it"};
}

const Json& identity_in(const Json& said) { return said.contains("camera") ? said["camera"] : said; }

std::string records_of(const std::string& run) {
  const std::string path = log_path(run, "calibration.json");
  if (!has_regular_file(path)) return "none";
  std::vector<std::string> records;
  const Json whole = parse_distinct(read_all(path, Content::text, std::uint64_t{1} << 20), path);
  for (const auto& [scan, record] : whole.items()) {
    if (record.is_object()) records.push_back(scan + " of " + text_at(record, "utc"));
  }
  return join(records, ", ");
}

}  // namespace

std::string device_name(const Json& identity) {
  std::string name;
  for (const char* key : {"maker", "model", "serial"}) {
    if (const std::string text = text_at(identity_in(identity), key); !text.empty())
      name += (name.empty() ? "" : " ") + text;
  }
  return name;
}

std::vector<UsedDevice> used_devices(const std::string& run) {
  std::vector<UsedDevice> devices;
  for (const auto& [log, what] :
       {std::pair{"flips.jsonl", ""}, {"stage.jsonl", "stage"}, {"capture.jsonl", "camera"}}) {
    LogLines lines(log_path(run, log));
    Json line;
    for (int n = 0; n < 8 && lines.next(line); ++n) {
      const Json& identity = identity_in(line);
      const std::string device = text_at(identity, "device", device_name(identity));
      if (device.empty()) continue;
      devices.push_back(
          {*what == '\0' ? text_at(line, "event") : what, device, identity.value("simulated", Json()) == true});
    }
  }
  return devices;
}

bool is_printed(const std::string& run) {
  const std::string path = log_path(run, "events.jsonl");
  const int events = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (events < 0) return false;
  const bool held = flock(events, LOCK_SH | LOCK_NB) != 0;
  close(events);
  return held;
}

std::vector<std::string> run_facts(const std::string& run) {
  const RunEvents events = read_events(run);
  const auto hash = [](const std::string& sha256) { return sha256.empty() ? "" : ", SHA-256 " + sha256.substr(0, 16); };
  std::vector<std::string> devices;
  for (const UsedDevice& one : used_devices(run))
    devices.push_back(one.what + " " + one.device + (one.simulated ? " (simulated)" : ""));
  std::vector<std::string> facts{"armed      " + events.armed_utc + hash(events.sinogram_sha256),
                                 "devices    " + join(devices, ", "), "records    " + records_of(run)};
  if (!events.resumes.empty()) facts.push_back("resumes    " + events.resumes);
  if (has_regular_file(log_path(run, flips_log))) {
    FlipLog log(run);
    log.read();
    const double lit_deg = log.last_lit() != nullptr ? log.last_lit()->angle_deg : events.from_deg;
    for (const ShownSinogram& one : log.sinograms()) facts.push_back("sinogram   " + one.name + hash(one.sha256));
    facts.push_back("delivered  turn " + fixed_number(lit_deg / 360, 2) + " of " + format_number(events.turns) +
                    ", from " + fixed_number(events.from_deg / 360, 2) + " on: " + std::to_string(log.lit()) +
                    " images, " + std::to_string(log.missed()) + " of " + std::to_string(log.blanks()) +
                    " vertical blanks missed");
  }
  std::string end = is_printed(run) ? "it goes on" : "not logged: it was killed";
  if (events.outcome) end = events.ended_utc + ": " + *events.outcome + ", status " + std::to_string(events.status);
  facts.push_back("ended      " + end);
  if (!events.resumed_by.empty()) facts.push_back("resumed by " + events.resumed_by);
  return facts;
}

RunEvents read_events(const std::string& run) {
  RunEvents events;
  LogLines lines(log_path(run, "events.jsonl"));
  for (Json event; lines.next(event);) take_event(event, events);
  return events;
}

void require_logs(const std::string& run) {
  RunEvents events = read_events(run);
  for (const char* name : {flips_log, "angles.jsonl"}) events.logs.try_emplace(name);
  for (const auto& [name, stated] : events.logs) require_log(log_path(run, name), stated);
}

std::string sealed_flips(const std::string& run) {
  const RunEvents events = read_events(run);
  const auto found = events.logs.find(flips_log);
  if (found == events.logs.end()) return "";
  return std::string(flips_log) + " is sealed up to byte " + std::to_string(found->second.bytes) + " of " +
         std::to_string(std::filesystem::file_size(log_path(run, flips_log)));
}

}  // namespace vam::io

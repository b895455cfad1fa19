// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>

#include "base/error.hpp"
#include "base/log/chain.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "io/settings/run_folder.hpp"
#include "io/stream/log_lines.hpp"

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

}  // namespace

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/inspect/provenance.hpp"

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/log/log.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/exr/stack.hpp"
#include "io/image/any_frames.hpp"
#include "io/image/capture_folder.hpp"
#include "io/image/image_file.hpp"
#include "io/settings/printer_file.hpp"
#include "io/settings/run_folder.hpp"
#include "io/settings/sealed_text.hpp"
#include "io/stream/file_type.hpp"
#include "io/stream/seal.hpp"
#include "io/stream/stream.hpp"
#include "io/vdb/vdb.hpp"

namespace vam::io {

namespace {

std::vector<ProvenanceEntry> inspect_stacks(const std::string& path, bool fast) {
  std::vector<ProvenanceEntry> findings;
  StackReader reader(path, true, fast);
  do {
    Image image;
    model::ImageInfo about;
    while (!fast && reader.next(image, about)) continue;
    findings.push_back({"stack of " + std::to_string(reader.info().count) + " images", reader.is_sealed(),
                        reader.seal(), reader.info().history});
  } while (!fast && reader.next_stack());
  if (findings.size() > 1 && std::filesystem::is_regular_file(path)) {
    warn(path + ": holds " + std::to_string(findings.size()) +
         " stacks, one behind the other, as a live capture does; tools that read one refuse it");
  }
  return findings;
}

std::vector<ProvenanceEntry> inspect_volumes(const std::string& path, bool fast) {
  std::vector<ProvenanceEntry> findings;
  for (const auto& facts : check_volumes(path, fast)) {
    findings.push_back({"grid " + excerpt(facts.name), !facts.seal.empty(), facts.seal, facts.history});
  }
  return findings;
}

std::vector<ProvenanceEntry> inspect_images(const std::string& path, FileType type, bool fast) {
  const auto source = open_images(path, type);
  Image image;
  model::ImageInfo about;
  while (!fast && source->next(image, about)) continue;
  const char* what = type == FileType::video ? "video" : "folder of images";
  return {{what, source->is_sealed(), source->seal(), source->info().history, source->has_checksums()}};
}

// A print that goes on, or was killed: its settings and logs are what they were, up to where its events state them.
std::vector<ProvenanceEntry> inspect_unended(const std::string& path) {
  const auto outcome = read_events(path).outcome;  // first: the log states the version of the folder
  require_run(path);
  if (outcome) {
    throw Error{Fault::data,
                path +
                    ": has no SHA256SUMS and no whole summary.json, which a print writes within a minute of "
                    "its end (" +
                    *outcome + ", by events.jsonl); wait, or restore both; if it was killed in that " +
                    "minute, nothing of it can be verified"};
  }
  if (const std::string sealed = sealed_flips(path); !sealed.empty())
    return {{"run folder of a print that goes on or was killed: " + sealed, true, "", {}, false, {}, run_facts(path)}};
  throw Error{Fault::data, path +
                               ": has no SHA256SUMS, which a print writes when it has ended: it goes on, was "
                               "killed, or the list is gone; nothing of it can be verified"};
}

// A print that has ended left a list of hashes.
std::vector<ProvenanceEntry> inspect_run(const std::string& path, bool fast) {
  require_run_versions(path);
  if (has_run_sums(path)) {
    const RunSums sums = read_run_sums(path);
    auto damage = run_damage(path, sums, fast);
    if (damage.empty() && !fast) require_logs(path);
    const auto facts = damage.empty() ? run_facts(path) : std::vector<std::string>{};
    return {{"run folder of " + std::to_string(sums.size()) + " files", true, "", {}, false, damage, facts}};
  }
  if (!has_regular_file((std::filesystem::path(path) / "summary.json").string())) return inspect_unended(path);
  require_run_logs(path);
  if (sealed_flips(path).empty()) return {{"run folder without SHA256SUMS", false, "", {}, false, {}, run_facts(path)}};
  throw Error{Fault::data, path +
                               ": has no SHA256SUMS, which a print writes when it has ended; only its logs can be "
                               "verified; restore the list"};
}

std::vector<ProvenanceEntry> inspect_capture(const std::string& path, bool fast) {
  const CaptureManifest manifest = read_manifest(path);
  const std::string what = "capture folder of " + std::to_string(manifest.frames.size()) + " images";
  return {{what, manifest.sealed, "", {}, false, capture_damage(path, manifest, fast)}};
}

std::vector<ProvenanceEntry> inspect_folder(const std::string& path, bool fast) {
  const bool is_run = has_run_sums(path) || has_regular_file((std::filesystem::path(path) / "events.jsonl").string());
  if (is_run) return inspect_run(path, fast);
  return is_capture_folder(path) ? inspect_capture(path, fast) : inspect_images(path, FileType::images, fast);
}

// What the tools that use a record of a calibration would refuse.
void require_record_size(const Json& json, const std::string& text, const std::string& name) {
  const bool is_record = is_of(json, "vam-calibration") || is_of(json, "vam-resin") || is_of(json, "vam-working-curve");
  if (text.size() <= most_record_bytes || !is_record) return;
  throw Error{Fault::data, name + ": has " + std::to_string(text.size()) +
                               " bytes; a calibration record has at most 1 MiB; measure it again"};
}

std::vector<ProvenanceEntry> inspect_text(const std::string& path, bool fast) {
  constexpr std::uint64_t most_bytes = std::uint64_t{64} << 20;
  const std::string name = input_name(path);
  const std::filesystem::path file(path);
  if (!fast && file.filename() == "flips.jsonl" && has_regular_file((file.parent_path() / "events.jsonl").string())) {
    const std::string run = file.parent_path().string();
    require_run_logs(run.empty() ? "." : run);
    const std::string sealed = sealed_flips(run);
    return {{"flips of a print" + (sealed.empty() ? "" : ": " + sealed), !sealed.empty(), "", {}}};
  }
  const std::string text = read_all(path, Content::text, most_bytes);
  if (text.empty()) throw Error{Fault::data, name + ": is empty; the program that should have written it failed"};
  const Json head = parse_distinct(text.substr(0, text.find('\n')), name);  // a log states its version
  if (file.filename() == "manifest.jsonl" && is_of(head, "vam-capture")) {  // it says nothing without the images
    const std::string folder = file.parent_path().string();
    return inspect_capture(folder.empty() ? "." : folder, fast);
  }
  if (path.ends_with(".jsonl") && has_regular_file(path)) {
    LogLines lines(path);
    for (std::string line; lines.next(line);) continue;
    if (lines.is_chained()) return {{"log", true, "", {}}};
  }
  const Json json = parse_distinct(text, name);
  if (json.is_object()) {
    require_record_size(json, text, name);
    ProvenanceEntry finding{
        json.contains("schema") ? briefly(json["schema"].dump()) : "JSON", require_seal(json, name), "", {}};
    if (json.contains("tool") && json["tool"].is_string()) finding.history.push_back(json["tool"].get<std::string>());
    return {finding};
  }
  if (path.ends_with(".json") && !json.is_discarded()) {
    throw Error{Fault::data, name + ": holds JSON of the type " + json.type_name() +
                                 ", where records and reports are an object; write it again"};
  }
  if (path.ends_with(".json") || (text.front() == '{' && text.find("\"seal\":") != std::string::npos)) {
    throw Error{Fault::data, name + ": is damaged: no longer JSON; write it again"};
  }
  if (!has_printer_section(text) && !path.ends_with(".toml")) {
    const std::string foreign = text.front() == '{' ? "" : foreign_format(text);
    if (!fast && text.starts_with("\x89PNG\r\n")) require_png(text, name);
    return {{foreign.empty() ? "file of another kind" : foreign, require_text_seal(text, name), "", {}}};
  }
  const bool sealed = require_text_seal(text, name);
  (void)parse_printer(text, name);  // one that the tools wrote has a mark at its end, which a cut loses
  if (const std::string sign = sign_of_cut(text); !sealed && !sign.empty()) warn(name + ": " + sign);
  return {{"printer file", sealed, "", {}}};
}

}  // namespace

std::vector<ProvenanceEntry> inspect(const std::string& path, bool fast) {
  const std::filesystem::path file(path);
  if (file.filename() == "flips.jsonl" && !has_regular_file(path)) require_logs(file.parent_path().string());
  const auto type = known_file_type(path);
  if (!type) {
    for (const char* ending : {".exr", ".vdb", ".mkv"}) {
      if (!path.ends_with(ending) || !std::filesystem::is_regular_file(path) || std::filesystem::is_empty(path))
        continue;
      throw Error{Fault::data, path + ": is damaged: does not begin as a file " + ending + " does"};
    }
    return inspect_text(path, fast);
  }
  switch (*type) {
    case FileType::volume:
      return inspect_volumes(path, fast);
    case FileType::stack:
      return inspect_stacks(path, fast);
    case FileType::images:
      return inspect_folder(path, fast);
    default:
      return inspect_images(path, *type, fast);
  }
}

std::vector<Step> chain_of(const ProvenanceEntry& finding) {
  std::vector<Step> chain;
  for (const std::string& line : finding.history) {
    const std::string seal = chained_seal(line);
    if (seal.empty()) {
      chain.push_back({line, ""});
    } else if (!chain.empty()) {
      chain.back().seal = seal;
    }
  }
  if (!chain.empty()) chain.back().seal = finding.seal;
  return chain;
}

}  // namespace vam::io

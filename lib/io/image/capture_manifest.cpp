// SPDX-License-Identifier: GPL-3.0-or-later
// The manifest of a capture folder, line by line.
#include "io/image/private/capture_manifest.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

namespace fs = std::filesystem;

constexpr const char* remedy = "; restore the manifest, or capture again";

std::optional<double> optional_number(const Json& line, const char* key) {
  const auto found = line.find(key);
  if (found == line.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

// Of a frame. `where` begins the message.
long number_of(const Json& value, const std::string& where) {
  constexpr long most = 1L << 48;
  const long number = value.is_number_integer() ? value.get<long>() : most + 1;
  if (number >= -most && number <= most) return number;
  throw Error{Fault::data, where + ": " + briefly(value.dump()) + " is not the number of a frame; remove the line"};
}

// What stands at a key of a line that must have it, of the type that `example` has.
const Json& needed(const Json& line, const char* key, const Json& example, const std::string& where) {
  const auto found = line.find(key);
  if (found == line.end()) throw Error{Fault::data, where + ": has no key '" + key + "'" + remedy};
  const bool numbers = found->is_number() && example.is_number();
  if (!numbers && found->type() != example.type()) {
    throw Error{Fault::data, where + ": its key '" + key + "' is a " + found->type_name() + ", not a " +
                                 example.type_name() + remedy};
  }
  return *found;
}

CaptureRecord to_record(const Json& line, const std::string& where) {
  const Json number = 0, truth = true, text = "";
  CaptureRecord record;
  if (!line.contains("frame")) throw Error{Fault::data, where + ": has no key 'frame'" + remedy};
  if (!line.contains("number")) throw Error{Fault::data, where + ": has no key 'number'" + remedy};
  record.place = number_of(line["frame"], where);
  record.number = number_of(line["number"], where);
  if (record.place < 0)
    throw Error{Fault::data, where + ": frame " + std::to_string(record.place) + " is before the first" + remedy};
  record.t_monotonic_s = needed(line, "t_monotonic_s", number, where).get<double>();
  record.time_sigma_s = optional_number(line, "time_sigma_s");
  record.device_s = optional_number(line, "device_s");
  record.angle_deg = optional_number(line, "angle_deg");
  record.sigma_deg = optional_number(line, "sigma_deg");
  record.complete = needed(line, "complete", truth, where).get<bool>();
  record.levels = needed(line, "levels", text, where).get<std::string>();
  return record;
}

// What no camera has; 0 where a number is not known.
void require_head(const Json& line, const std::string& where) {
  struct Bound {
    const char* key;
    double low, high;
  };
  for (const Bound& bound : {Bound{"columns", 1, 65536},
                             {"rows", 1, 65536},
                             {"bits", 1, 16},
                             {"pixel_mm", 0, 100},
                             {"fps", 0, 1e6},
                             {"every_deg", 0, 1e6}}) {
    const double value = number_at(line, bound.key, bound.low);
    if (value >= bound.low && value <= bound.high) continue;
    throw Error{Fault::data, where + ": " + bound.key + " is " + format_number(value) + ", not from " +
                                 format_number(bound.low) + " to " + format_number(bound.high) + remedy};
  }
}

void require_line_seal(CaptureManifest& manifest, const Json& line, const std::string& where) {
  const bool first = manifest.head.empty();
  const bool has = line.contains(manifest_seal_key);
  if (first) manifest.sealed = has;
  if (has != manifest.sealed) {
    throw Error{Fault::data,
                where +
                    (has ? ": has a seal, but those before have none" : ": has no seal, but those before have one") +
                    remedy};
  }
  if (!has) return;
  const Digest read = manifest_seal(manifest.seal, line);
  Digest sealed;
  const bool whole =
      line[manifest_seal_key].is_string() && parse_seal(line[manifest_seal_key].get<std::string>(), sealed);
  if (!whole || sealed != read) {
    throw Error{Fault::data,
                where + ": changed after it was written, or lines before it are gone (" +
                    (whole ? "sealed " + shortened(sealed) + ", read " : std::string("seal unreadable, hash ")) +
                    shortened(read) + ")" + remedy};
  }
  manifest.seal = read;
}

void require_counts(const CaptureManifest& manifest, const Json& line, const std::string& where) {
  const long frames = number_of(line["frames"], where);
  if (frames == std::ssize(manifest.frames)) return;
  throw Error{Fault::data, where + ": states " + std::to_string(frames) + " frames, but " +
                               std::to_string(manifest.frames.size()) + " are listed before it" + remedy};
}

void take_dropped(CaptureManifest& manifest, const Json& range, const std::string& where) {
  if (!range.is_array() || range.size() != 2)
    throw Error{Fault::data,
                where + ": " + excerpt(range.dump()) + " is not the first and the last of dropped frames" + remedy};
  manifest.dropped += number_of(range[1], where) - number_of(range[0], where) + 1;
}

void add_line(CaptureManifest& manifest, const std::string& text, const std::string& where) {
  const Json line = parse_distinct(text, where);
  if (!line.is_object()) throw Error{Fault::data, where + ": is not a line of a manifest: no JSON object" + remedy};
  if (manifest.head.empty() && !is_of(line, "vam-capture")) {
    throw Error{Fault::data, where + ": is not a manifest of vam-capture" + remedy};
  }
  require_line_seal(manifest, line, where);
  manifest.ended = false;
  if (manifest.head.empty()) {
    require_head(line, where);
    manifest.head = text;
  } else if (line.contains("dropped")) {
    take_dropped(manifest, line["dropped"], where);
  } else if (line.contains("frames")) {
    require_counts(manifest, line, where);
    manifest.ended = true;
  } else {
    const CaptureRecord record = to_record(line, where);
    const auto [there, fresh] = manifest.frames.try_emplace(record.place, record);
    if (!fresh && (record.complete || !there->second.complete)) there->second = record;
  }
}

}  // namespace

std::string manifest_path(const std::string& folder) { return (fs::path(folder) / "manifest.jsonl").string(); }

Digest manifest_seal(const Digest& before, const Json& line) {
  Json rest = line;
  rest.erase(manifest_seal_key);
  Sealer all;
  all.add(before);
  all.add(Json::parse(rest.dump()).dump());  // as it reads back: a number that is none is null there
  return all.digest();
}

bool is_capture_folder(const std::string& folder) { return has_regular_file(manifest_path(folder)); }

CaptureManifest read_manifest(const std::string& folder) {
  const std::string path = manifest_path(folder);
  constexpr std::uint64_t most_bytes = std::uint64_t{256} << 20U;  // a million frames
  const std::string text = read_all(path, Content::text, most_bytes);
  CaptureManifest manifest;
  long number = 0;
  std::size_t begin = 0;
  for (std::size_t end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1) {
    add_line(manifest, text.substr(begin, end - begin), path + ": line " + std::to_string(++number));
  }
  manifest.cut_bytes = text.size() - begin;
  if (manifest.head.empty()) {
    throw Error{Fault::data, path + ": is empty; restore the manifest, or capture again into another folder"};
  }
  return manifest;
}

}  // namespace vam::io

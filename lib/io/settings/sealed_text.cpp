// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/sealed_text.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

#include "base/error.hpp"
#include "base/log/log_lines.hpp"
#include "base/text/json.hpp"
#include "base/text/json_text.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "io/stream/seal.hpp"
#include "io/stream/stream.hpp"

namespace vam::io {

namespace {

constexpr const char* json_key = "seal";
const std::string text_head = "# sealed ";
constexpr std::size_t seal_size = 37;  // that of seal_text()

using Sorted = nlohmann::json;  // its keys are in alphabetical order

// 3.0 is the 3 that other programs write for it.
void make_whole(Sorted& value) {
  constexpr double most = 9007199254740992;  // 2^53: beyond, not every whole number is a double
  for (Sorted& part : value) {
    if (part.is_structured()) make_whole(part);
    if (!part.is_number_float()) continue;
    if (const auto number = part.get<double>(); std::abs(number) <= most && number == std::trunc(number))
      part = static_cast<std::int64_t>(number);
  }
}

/// Of keys and values of an object without its seal, whatever their order and layout.
Digest digest_of_values(Json object) {
  object.erase(json_key);
  // As it reads back: a number that is none is null there.
  const std::string text = object.dump(-1, ' ', false, Json::error_handler_t::replace);
  Sorted sorted = Sorted::parse(text);
  make_whole(sorted);
  const std::string canonical = sorted.dump();
  return digest_of(canonical.data(), canonical.size());
}

void require_equal(const std::string& seal, const Digest& read, const std::string& name, const std::string& remedy) {
  Digest sealed;
  const bool whole = parse_seal(seal, sealed);
  if (whole && sealed == read) return;
  throw Error{Fault::data, name + ": changed after it was written (" +
                               (whole ? "sealed " + shortened(sealed) + ", read " : "seal unreadable, hash ") +
                               shortened(read) + "); " + remedy};
}

std::string without(const std::string& seal) {
  return "create it again, or remove " + seal + " if the change was intentional";
}

bool is_seal(std::string_view text) {
  Digest ignored;
  return parse_seal(text, ignored);
}

/// Where the line of the seal begins: anywhere with its whole head, as text may have been added; at the end with what
/// damage of one byte leaves of it, `# sealed ` or the hash. Other comments may have words in common with it.
std::optional<std::size_t> seal_line(const std::string& text) {
  constexpr auto none = std::string::npos;
  if (const auto feed = text.rfind("\n" + text_head + "xxh3:"); feed != none) return feed + 1;
  const std::size_t last = text.size() - std::min(text.size(), 1 + text_head.size() + seal_size + 1);
  if (const auto feed = text.find("\n" + text_head, last); feed != none) return feed + 1;
  const std::string_view lines = std::string_view(text).substr(0, text.find_last_not_of('\n') + 1);
  if (lines.size() < seal_size || !is_seal(lines.substr(lines.size() - seal_size))) return std::nullopt;
  return lines.rfind('\n') + 1;  // 0 where it is the only one
}

}  // namespace

void seal_json(Json& object) {
  const Digest digest = digest_of_values(object);
  object[json_key] = seal_text(digest);
}

bool require_seal(const Json& object, const std::string& name) {
  if (!object.is_object()) return false;
  auto seal = object.find(json_key);
  if (seal == object.end()) {  // its key may be damaged
    seal = std::find_if(object.begin(), object.end(),
                        [](const Json& value) { return value.is_string() && is_seal(value.get<std::string>()); });
  }
  if (seal == object.end()) return false;
  const bool readable = seal.key() == json_key && seal->is_string();
  require_equal(readable ? seal->get<std::string>() : "", digest_of_values(object), name,
                without("its key " + seal.key()));
  return true;
}

std::string sealed_text(std::string text) {
  const Digest digest = digest_of(text.data(), text.size());
  return std::move(text) + text_head + seal_text(digest) + "\n";
}

bool require_text_seal(const std::string& text, const std::string& name) {
  const auto line = seal_line(text);
  if (!line) return false;
  std::string seal = text.substr(*line);
  const bool whole = seal.starts_with(text_head) && seal.back() == '\n';
  if (whole) seal = seal.substr(text_head.size(), seal.size() - text_head.size() - 1);
  const Digest digest = digest_of(text.data(), *line);
  const std::string folder = std::filesystem::path(name).parent_path().string();
  const bool in_run = has_regular_file((folder.empty() ? "." : folder) + "/events.jsonl");  // where none is intentional
  require_equal(whole ? seal : "", digest, name,
                in_run ? "restore it" : without("its last line '" + text_head + "...'"));
  return true;
}

void write_report(const std::string& path, FormatKind schema, const Json& figures) {
  if (path.empty()) return;
  Json report{{"schema", schema.schema()}};
  report.update(figures);
  seal_json(report);
  write_text(path, report.dump(2) + "\n");
}

double gelation_isovalue(const std::string& path) {
  const Json record = sealed_record(path, {"vam-resin", "vam-working-curve"});
  const double isovalue = number_at(record, "isovalue");
  const double critical = number_at(record, "critical_dose_mj_cm3", 1);
  if (!(critical > 0)) {
    throw Error{Fault::data, path + ": critical_dose_mj_cm3 is " + format_number(critical) +
                                 "; it must be above 0; measure it again"};
  }
  if (!(isovalue > 0)) {
    throw Error{Fault::data, path + ": isovalue is " + format_number(isovalue) + "; it must be above 0"};
  }
  return isovalue;
}

Json sealed_record(const std::string& path, std::initializer_list<FormatKind> schemas) {
  Json record = parse_distinct(read_all(path, Content::text, most_record_bytes), path);
  std::vector<std::string> known;
  for (const FormatKind& schema : schemas) {
    if (is_of(record, schema)) return (void)require_seal(record, path), record;
    known.push_back(schema.schema());
  }
  const std::string stated = text_at(record, "schema");
  throw Error{Fault::data, path + ": not JSON of the schema " + join(known, " or ") +
                               (stated.empty() ? "" : ", but of " + briefly(stated))};
}

}  // namespace vam::io

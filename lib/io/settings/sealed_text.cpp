// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/sealed_text.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/json.hpp"
#include "io/stream/seal.hpp"

namespace vam::io {

namespace {

constexpr const char* json_key = "seal";
const std::string text_head = "# sealed ";

Digest digest_of_json(Json object) {
  object.erase(json_key);
  // As it reads back: a number that is none is null there.
  const std::string text = Json::parse(object.dump(-1, ' ', false, Json::error_handler_t::replace)).dump();
  return digest_of(text.data(), text.size());
}

void require_equal(const std::string& seal, const Digest& read, const std::string& name, const std::string& where) {
  Digest sealed;
  const bool whole = parse_seal(seal, sealed);
  if (whole && sealed == read) return;
  throw Error{Fault::data, name + ": changed after it was written (" +
                               (whole ? "sealed " + shortened(sealed) + ", read " : "seal unreadable, hash ") +
                               shortened(read) + "); create it again, or remove " + where +
                               " if the change was intentional"};
}

// The line feed before it. Damage leaves one half of its head at least.
std::size_t seal_line(const std::string& text) {
  const std::size_t line = text.rfind("\n" + text_head);
  if (line != std::string::npos) return line;
  const std::size_t mark = text.rfind(" xxh3:");
  return mark == std::string::npos ? mark : text.rfind('\n', mark);
}

bool is_seal(const Json& value) {
  Digest ignored;
  return value.is_string() && parse_seal(value.get<std::string>(), ignored);
}

}  // namespace

void seal_json(Json& object) {
  const Digest digest = digest_of_json(object);
  object[json_key] = seal_text(digest);
}

bool require_seal(const Json& object, const std::string& name) {
  if (!object.is_object()) return false;
  if (!object.contains(json_key) && std::none_of(object.begin(), object.end(), is_seal)) return false;
  const Json seal = object.value(json_key, Json());  // whose key may be damaged
  require_equal(seal.is_string() ? seal.get<std::string>() : "", digest_of_json(object), name,
                std::string("its key ") + json_key);
  return true;
}

std::string sealed_text(std::string text) {
  const Digest digest = digest_of(text.data(), text.size());
  return std::move(text) + text_head + seal_text(digest) + "\n";
}

bool require_text_seal(const std::string& text, const std::string& name) {
  const std::size_t line = seal_line(text);
  if (line == std::string::npos) return false;
  std::string seal = text.substr(line + 1);
  const bool whole = seal.starts_with(text_head) && seal.back() == '\n';
  if (whole) seal = seal.substr(text_head.size(), seal.size() - text_head.size() - 1);
  require_equal(whole ? seal : "", digest_of(text.data(), line + 1), name, "its last line '" + text_head + "...'");
  return true;
}

}  // namespace vam::io

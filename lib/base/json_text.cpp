// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_text.hpp"

#include <set>
#include <vector>

#include "base/error.hpp"
#include "base/json.hpp"
#include "base/printable.hpp"

namespace vam {

namespace {

constexpr int most_levels = 64;

// `take` sees what the parser reports, with its level.
template <class Take>
Json parsed(std::string_view text, const Take& take) {
  // The parser takes a zero byte for the end.
  if (text.find('\0') != std::string_view::npos) return Json(Json::value_t::discarded);
  bool refused = false;
  const auto keep = [&](int level, Json::parse_event_t event, const Json& value) {
    refused = refused || level > most_levels;
    if (!refused) take(level, event, value);
    return !refused;
  };
  Json value = Json::parse(text, keep, false);
  return refused ? Json(Json::value_t::discarded) : value;
}

}  // namespace

Json parse_json(std::string_view text) {
  return parsed(text, [](int, Json::parse_event_t, const Json&) {});
}

Json parse_distinct(std::string_view text, const std::string& name) {
  std::vector<std::set<std::string>> seen(most_levels + 2);  // by the level of their object
  std::string twice;
  Json value = parsed(text, [&](int level, Json::parse_event_t event, const Json& of) {
    if (event == Json::parse_event_t::object_start) seen[level + 1].clear();
    if (event == Json::parse_event_t::key && !seen[level].insert(of.get<std::string>()).second && twice.empty())
      twice = excerpt(of.get<std::string>());
  });
  if (value.is_discarded() || twice.empty()) return value;
  throw Error{Fault::data,
              name + ": has the key " + twice + " twice in one object, of which only one would count; write it again"};
}

double number_at(const Json& object, const char* key, double otherwise) {
  return object.contains(key) && object[key].is_number() ? object[key].get<double>() : otherwise;
}

std::string text_at(const Json& object, const char* key, const std::string& otherwise) {
  return object.contains(key) && object[key].is_string() ? object[key].get<std::string>() : otherwise;
}

}  // namespace vam

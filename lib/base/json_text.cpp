// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_text.hpp"

#include <set>
#include <vector>

#include "base/json.hpp"

namespace vam {

Json parse_json(std::string_view text, Keys keys) {
  // The parser takes a zero byte for the end.
  if (text.find('\0') != std::string_view::npos) return Json(Json::value_t::discarded);
  constexpr int most_levels = 64;
  bool refused = false;
  std::vector<std::set<std::string>> seen(most_levels + 2);  // by the level of their object
  const auto keep = [&](int level, Json::parse_event_t event, const Json& value) {
    refused = refused || level > most_levels;
    if (refused || keys == Keys::any) return !refused;
    if (event == Json::parse_event_t::object_start) seen[level + 1].clear();
    if (event == Json::parse_event_t::key) refused = !seen[level].insert(value.get<std::string>()).second;
    return !refused;
  };
  Json value = Json::parse(text, keep, false);
  return refused ? Json(Json::value_t::discarded) : value;
}

double number_at(const Json& object, const char* key, double otherwise) {
  return object.contains(key) && object[key].is_number() ? object[key].get<double>() : otherwise;
}

std::string text_at(const Json& object, const char* key, const std::string& otherwise) {
  return object.contains(key) && object[key].is_string() ? object[key].get<std::string>() : otherwise;
}

}  // namespace vam

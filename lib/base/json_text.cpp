// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_text.hpp"

#include "base/json.hpp"

namespace vam {

Json parse_json(std::string_view text) {
  constexpr int most_levels = 64;
  bool too_deep = false;
  const auto keep = [&](int level, Json::parse_event_t, const Json&) {
    too_deep = too_deep || level > most_levels;
    return !too_deep;
  };
  Json value = Json::parse(text, keep, false);
  return too_deep ? Json(Json::value_t::discarded) : value;
}

double number_at(const Json& object, const char* key, double otherwise) {
  return object.contains(key) && object[key].is_number() ? object[key].get<double>() : otherwise;
}

std::string text_at(const Json& object, const char* key, const std::string& otherwise) {
  return object.contains(key) && object[key].is_string() ? object[key].get<std::string>() : otherwise;
}

}  // namespace vam

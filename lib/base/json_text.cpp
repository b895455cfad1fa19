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

}  // namespace vam

// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/json_text.hpp"

#include <set>
#include <vector>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/printable.hpp"

namespace vam {

namespace {

// Depth, as what walks a value calls itself once a level; keys, as each of an object is looked up among those before
// it.
constexpr std::size_t most_levels = 64;
constexpr std::size_t most_keys = 1024;

// Looks at a text before a value is made of it. The parser's own callback searches an array anew after each of its
// objects.
class Judge final : public nlohmann::json_sax<Json> {
 public:
  [[nodiscard]] bool too_many() const { return too_many_; }
  [[nodiscard]] const std::string& twice() const { return twice_; }  // in quotes; empty: none

  bool start_object(std::size_t /*count*/) override { return begin(); }
  bool start_array(std::size_t /*count*/) override { return begin(); }
  bool end_object() override { return end(); }
  bool end_array() override { return end(); }
  bool key(std::string& name) override {
    std::set<std::string>& keys = open_.back();
    if (!keys.insert(name).second && twice_.empty()) twice_ = excerpt(name);
    too_many_ = keys.size() > most_keys;
    return !too_many_;
  }

  bool null() override { return true; }
  bool boolean(bool /*value*/) override { return true; }
  bool number_integer(Json::number_integer_t /*value*/) override { return true; }
  bool number_unsigned(Json::number_unsigned_t /*value*/) override { return true; }
  bool number_float(Json::number_float_t /*value*/, const std::string& /*text*/) override { return true; }
  bool string(std::string& /*value*/) override { return true; }
  bool binary(Json::binary_t& /*value*/) override { return true; }
  bool parse_error(std::size_t /*at*/, const std::string& /*token*/, const Json::exception& /*why*/) override {
    return false;
  }

 private:
  bool begin() {
    open_.emplace_back();
    return open_.size() <= most_levels;
  }
  bool end() {
    open_.pop_back();
    return true;
  }

  std::vector<std::set<std::string>> open_;  // the keys of each object that is not closed yet; none of an array
  std::string twice_;
  bool too_many_ = false;
};

Json judged(std::string_view text, Judge& judge) {
  // The parser takes a zero byte for the end.
  const bool whole = text.find('\0') == std::string_view::npos && Json::sax_parse(text, &judge);
  return whole ? Json::parse(text, nullptr, false) : Json(Json::value_t::discarded);
}

}  // namespace

Json parse_json(std::string_view text) {
  Judge judge;
  return judged(text, judge);
}

Json parse_distinct(std::string_view text, const std::string& name) {
  Judge judge;
  Json value = judged(text, judge);
  if (judge.too_many()) {
    throw Error{Fault::data, name + ": has an object of more than " + std::to_string(most_keys) +
                                 " keys, which none of these tools writes; write it again"};
  }
  if (value.is_object()) {  // first: a later version may mean something else by the rest
    const std::string why = schema_objection(text_at(value, "schema"));
    if (!why.empty()) throw Error{Fault::data, name + ": " + why};
  }
  if (value.is_discarded() || judge.twice().empty()) return value;
  throw Error{Fault::data, name + ": has the key " + judge.twice() +
                               " twice in one object, of which only one would count; write it again"};
}

bool is_of(const Json& value, FormatKind kind) {
  const std::string schema = value.is_object() ? text_at(value, "schema") : "";
  return schema.substr(0, schema.find('/')) == kind.kind();
}

double number_at(const Json& object, const char* key, double otherwise) {
  return object.contains(key) && object[key].is_number() ? object[key].get<double>() : otherwise;
}

std::string text_at(const Json& object, const char* key, const std::string& otherwise) {
  return object.contains(key) && object[key].is_string() ? object[key].get<std::string>() : otherwise;
}

}  // namespace vam

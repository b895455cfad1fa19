// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/json_text.hpp"

#include <ctime>

#include "base/text/json.hpp"
#include "testing.hpp"

using namespace vam;

TEST_CASE("a text that is no JSON, or nested beyond 64 levels, is discarded") {
  const auto nested = [](int levels, const char* value = "") {
    return std::string(levels, '[') + value + std::string(levels, ']');
  };
  CHECK(parse_json("{\"a\": [1, {\"b\": 2}]}").dump() == "{\"a\":[1,{\"b\":2}]}");
  CHECK(parse_json(nested(64)).dump() == nested(64));
  CHECK(parse_json(nested(64, "1")).dump() == nested(64, "1"));
  CHECK(parse_json(nested(65, "1")).is_discarded());
  for (const std::string& text : {nested(66), nested(100'000), "{\"a\":" + nested(100'000) + ",\"b\":1}", std::string(),
                                  std::string("{\"a\":1"), std::string("{} {}")}) {
    CHECK(parse_json(text).is_discarded());
  }
}

TEST_CASE("a key that an object has twice is refused by name in what is evidence") {
  const char* twice = R"({"a": [{"b": 1, "c": {"b": 2}}, {"b": 3, "d": 4, "b": 5}]})";
  CHECK_FALSE(parse_json(twice).is_discarded());
  const auto refusal = [](const std::string& text) {
    return message_of([&] { (void)parse_distinct(text, "r.json"); });
  };
  const std::string said =
      R"(r.json: has the key 'b' twice in one object, of which only one would count; write it again)";
  CHECK(refusal(twice) == said);
  CHECK(refusal(R"({"b": {"b": 1, "c": {}}, "b": 2})") == said);
  CHECK(refusal("{\"\x80\": 1, \"\x80\": 2}").empty());  // no JSON
  CHECK(refusal(R"({"a": [{"b": 1, "c": {"b": 2}}, {"b": 3, "d": 4}], "b": 6})").empty());
  CHECK(parse_distinct("no JSON", "r.json").is_discarded());
  CHECK(parse_distinct(R"({"a": 1})", "r.json")["a"] == 1);
}

TEST_CASE("the time that a text takes grows as its length") {
  const auto objects = [](int count) {
    std::string text = "[";
    for (int i = 0; i < count; ++i) text += (i > 0 ? ",{\"k" : "{\"k") + std::to_string(i) + "\":1}";
    return text + "]";
  };
  const auto seconds = [](const std::string& text) {
    const std::clock_t before = std::clock();
    CHECK(parse_distinct(text, "r.json").is_array());
    return static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  };
  CHECK(seconds(objects(100'000)) < 40 * seconds(objects(5'000)));  // it was 400 times as long

  const auto keys = [](int count) {
    std::string text = "{";
    for (int i = 0; i < count; ++i) text += (i > 0 ? ",\"k" : "\"k") + std::to_string(i) + "\":1";
    return text + "}";
  };
  CHECK(parse_json(keys(1024)).size() == 1024);
  CHECK(parse_json(keys(1025)).is_discarded());
  CHECK(parse_json("[" + keys(1000) + "," + keys(1000) + "]").is_array());
  CHECK_THROWS_WITH_AS((void)parse_distinct(keys(1025), "r.json"),
                       "r.json: has an object of more than 1024 keys, which none of these tools writes; write it again",
                       Error);
}

TEST_CASE("a number or a text at a key, whatever else may stand there") {
  const Json object = parse_json("{\"a\": 1.5, \"b\": \"x\", \"c\": [2]}");
  CHECK(number_at(object, "a") == 1.5);
  CHECK(text_at(object, "b") == "x");
  for (const char* key : {"b", "c", "d"}) CHECK(number_at(object, key, -1) == -1);
  for (const char* key : {"a", "c", "d"}) CHECK(text_at(object, key, "none") == "none");
  CHECK(number_at(parse_json("[1]"), "a") == 0);
  CHECK(text_at(parse_json("no JSON"), "a").empty());
}

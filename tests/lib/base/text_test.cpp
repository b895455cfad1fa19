#include "base/text.hpp"

#include <doctest/doctest.h>

using namespace vam;

TEST_CASE("a number is the whole of its text") {
  CHECK(parse_number("0.065") == 0.065);
  CHECK(parse_number("+2") == 2.0);
  CHECK(parse_number("1e-3") == 1e-3);
  CHECK(parse_number("inf").has_value());
  for (const char* text : {"", "nan", "1x", " 1", "1 ", "--1"}) CHECK_FALSE(parse_number(text).has_value());
}

TEST_CASE("split keeps empty parts inside and at the end") {
  CHECK(split("a,,b,", ',') == std::vector<std::string>{"a", "", "b", ""});
  CHECK(split("", ',').empty());
}

TEST_CASE("nearest finds a misspelt word and no other") {
  const std::vector<std::string> known{"radius_mm", "wall_mm", "index_glass"};
  CHECK(nearest("radus_mm", known) == "radius_mm");
  CHECK(nearest("throw_ratio", known).empty());
  CHECK(did_you_mean("wall_m", known) == "; did you mean wall_mm?");
}

TEST_CASE("wrap breaks at blanks") { CHECK(wrap("aa bb cc", 6, 1) == " aa bb\n cc\n"); }

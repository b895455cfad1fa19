// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/text.hpp"

#include "testing.hpp"

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

TEST_CASE("a guess is at most a third of the word away, one letter of a short one") {
  const std::vector<std::string> known{"abcdefghi", "xy"};
  CHECK(nearest("bcdefg", known).empty());         // 3 letters missing, of 6
  CHECK(nearest("ABCdefghi", known) == known[0]);  // 3 of 9 changed
  CHECK(nearest("ABCDefghi", known).empty());
  CHECK(nearest("abcdefghiABC", known) == known[0]);  // 3 of 12 too many
  CHECK(nearest("xz", known) == known[1]);
  CHECK(nearest("zz", known).empty());
  CHECK(nearest("ab", {"ac", "ad"}) == "ac");  // the first of equals
}

TEST_CASE("a guess for the beginning of one word is that word") {
  CHECK(nearest("--vo", {"--no", "--voxel"}) == "--voxel");
  CHECK(nearest("--fit", {"--fit-writable", "--fit-width", "--fix"}) == "--fix");  // begins two of them
  CHECK(nearest("", {"--voxel"}).empty());
}

TEST_CASE("wrap breaks at blanks, in lines of at most the width") {
  CHECK(wrap("aa bb cc", 6, 1) == " aa bb\n cc\n");
  CHECK(wrap("aa bb cc", 5, 1) == " aa\n bb\n cc\n");
  CHECK(wrap("aaaaaaaa", 5, 1) == " aaaaaaaa\n");
  CHECK(wrap("aa  bb", 9, 0) == "aa bb\n");
  CHECK(wrap("", 9, 0).empty());
}

TEST_CASE("texts are trimmed and joined") {
  CHECK(trimmed("  a b \r\n") == "a b");
  CHECK(trimmed("a") == "a");
  CHECK(trimmed(" \n").empty());
  CHECK(join({"a", "b"}, ", ") == "a, b");
  CHECK(join({}, ", ").empty());
}

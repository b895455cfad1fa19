// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/text.hpp"

#include <string_view>

#include "base/text/base64.hpp"
#include "base/text/figure_text.hpp"
#include "base/text/utc.hpp"
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

TEST_CASE("base64 as the examples of RFC 4648, section 10") {
  CHECK(vam::base64("").empty());
  CHECK(vam::base64("f") == "Zg==");
  CHECK(vam::base64("fo") == "Zm8=");
  CHECK(vam::base64("foo") == "Zm9v");
  CHECK(vam::base64("foob") == "Zm9vYg==");
  CHECK(vam::base64("foobar") == "Zm9vYmFy");
  CHECK(vam::base64(std::string_view("\xff\x00\xfe", 3)) == "/wD+");
}

TEST_CASE("counts are written in full, other figures in short") {
  CHECK(format_figure(2085408) == "2085408");
  CHECK(format_figure(-143728, 5) == "-143728");
  CHECK(format_figure(0) == "0");
  CHECK(format_figure(0.1293214) == "0.129321");
  CHECK(format_figure(1.4373512e5, 5) == "1.4374e+05");
  CHECK(format_figure(1e300) == "1e+300");
  CHECK(format_figure(INFINITY) == "inf");
}

TEST_CASE("times are written and read to the millisecond") {
  constexpr double now_s = 1795280280.25;
  CHECK(utc_text(now_s) == "2026-11-21T16:58:00.250Z");
  CHECK(parse_utc("2026-11-21T16:58:00.250Z", "r") == now_s);
  CHECK(utc_text(-0.25) == "1969-12-31T23:59:59.750Z");
  CHECK(utc_text(0.9996) == "1970-01-01T00:00:01.000Z");
  for (int ms = 0; ms < 1000; ++ms) {
    const std::string text = utc_text(1795280280 + 0.001 * ms);
    CHECK(utc_text(parse_utc(text, "r")) == text);
  }
}

TEST_CASE("a text that is not a time is refused") {
  for (const char* text : {"yesterday", "2026-11-21T16:58:00.250Z and more", "2026-99-21T16:58:00.250Z",
                           "2026-02-30T16:58:00.250Z", "2026-11-21T16:58:00.250", ""}) {
    CHECK(fault_of([&] { (void)parse_utc(text, "r"); }) == Fault::data);
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/printable.hpp"

#include <string_view>

#include "testing.hpp"

TEST_CASE("control characters are shown, not sent") {
  CHECK(vam::printable("a b\n\t\x1b[31m\x7f") == "a b\\n\\t\\x1b[31m\\x7f");
  CHECK(vam::printable("\xc2\x9b"
                       "2J \xc2\xb5m \xc3\xa4") == "\\x9b2J \xc2\xb5m \xc3\xa4");
  CHECK(vam::printable(std::string_view("\0", 1)) == "\\x00");
  CHECK(vam::printable("\xc2") == "\\xc2");
  CHECK(vam::printable("\x1f ~") == "\\x1f ~");
  CHECK(vam::printable("\xc2\x7f\xc2\x80\xc2\x9f\xc2\xa0") == "\\xc2\\x7f\\x80\\x9f\xc2\xa0");
}

// By RFC 3629. What is no character of UTF-8 would make a page or a figure unreadable.
TEST_CASE("bytes that are no UTF-8 are shown as numbers") {
  CHECK(vam::printable("a\xff z") == "a\\xff z");
  CHECK(vam::printable("\xe2\x82\xac \xf0\x9f\x98\x80") == "\xe2\x82\xac \xf0\x9f\x98\x80");  // whole characters
  CHECK(vam::printable("a\xe2\x80\xaeltsz") == "a\\xe2\\x80\\xaeltsz");
  CHECK(vam::printable("\xe2\x81\xa6") == "\\xe2\\x81\\xa6");
  CHECK(vam::printable("\xe2\x80\x93") == "\xe2\x80\x93");  // a dash
  CHECK(vam::printable("\xe2\x82") == "\\xe2\\x82");
  CHECK(vam::printable("\xc0\x80 \xe0\x80\x80") == "\\xc0\\x80 \\xe0\\x80\\x80");  // too long
  CHECK(vam::printable("\xed\xa0\x80") == "\\xed\\xa0\\x80");                      // a surrogate
  CHECK(vam::printable("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");             // beyond U+10FFFF
}

TEST_CASE("a name in a page is escaped inside its link") {
  CHECK(vam::link_text("turns-1_a.png") == "turns-1_a.png");
  CHECK(vam::link_text("azAZ09.~") == "azAZ09.~");
  CHECK(vam::link_text("`{@[/:") == "%60%7B%40%5B%2F%3A");
  CHECK(vam::link_text("a\"><script>?\n\xc3\xa4") == "a%22%3E%3Cscript%3E%3F%0A%C3%A4");
}

TEST_CASE("a text in a page is escaped") {
  CHECK(vam::page_text("a < b & \"c\" > 'd'\n") == "a &lt; b &amp; &quot;c&quot; &gt; &#39;d&#39;\\n");
}

TEST_CASE("a long text is quoted by its begin") {
  CHECK(vam::excerpt("a\tb") == "'a\\tb'");
  const std::string whole(64, 'x');
  CHECK(vam::excerpt(whole) == "'" + whole + "'");
  CHECK(vam::excerpt(whole + "y") == "'" + whole + "...' (65 bytes)");
  const std::string cut = std::string(63, 'x') + "\xc3\xa4z";  // within a character
  CHECK(vam::excerpt(cut) == "'" + std::string(63, 'x') + "...' (66 bytes)");
}

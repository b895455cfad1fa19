#include "base/printable.hpp"

#include <doctest/doctest.h>

#include <string_view>

TEST_CASE("control characters are shown, not sent") {
  CHECK(vam::printable("a b\n\t\x1b[31m\x7f") == "a b\\n\\t\\x1b[31m\\x7f");
  CHECK(vam::printable("\xc2\x9b"
                       "2J \xc2\xb5m \xc3\xa4") == "\\x9b2J \xc2\xb5m \xc3\xa4");
  CHECK(vam::printable(std::string_view("\0", 1)) == "\\x00");
  CHECK(vam::printable("\xc2").size() == 1);
  CHECK(vam::printable("\x1f ~") == "\\x1f ~");
  CHECK(vam::printable("\xc2\x7f\xc2\x80\xc2\x9f\xc2\xa0") == "\xc2\\x7f\\x80\\x9f\xc2\xa0");
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

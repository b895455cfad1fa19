// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/base64.hpp"

#include <string_view>

#include "testing.hpp"

TEST_CASE("base64 as the examples of RFC 4648, section 10") {
  CHECK(vam::base64("").empty());
  CHECK(vam::base64("f") == "Zg==");
  CHECK(vam::base64("fo") == "Zm8=");
  CHECK(vam::base64("foo") == "Zm9v");
  CHECK(vam::base64("foob") == "Zm9vYg==");
  CHECK(vam::base64("foobar") == "Zm9vYmFy");
  CHECK(vam::base64(std::string_view("\xff\x00\xfe", 3)) == "/wD+");
}

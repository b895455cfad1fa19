// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/utc.hpp"

#include "testing.hpp"

using namespace vam;

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/json_log.hpp"

#include "testing.hpp"

using namespace vam;

TEST_CASE("a log that is not wanted is none, and one that cannot be written is an error") {
  CHECK(io::open_log("") == nullptr);
  CHECK(fault_of([] { (void)io::open_log("/nowhere/log"); }) == Fault::no_output);
}

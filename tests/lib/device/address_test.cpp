// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/os/address.hpp"

#include "testing.hpp"

using namespace vam;
using device::parse_address;

TEST_CASE("A device string is scheme, place and options") {
  const auto address = parse_address("gcs:/dev/serial/by-id/usb-PI:1?baud=9600&axis=A", {"gcs", "sim"});
  CHECK(address.scheme == "gcs");
  CHECK(address.place == "/dev/serial/by-id/usb-PI:1");
  CHECK(address.integer("baud", 50, 4000000) == 9600);
  CHECK(address.word("axis", "1") == "A");
  CHECK(address.number("timeout_s", 0.5, 0, 1) == 0.5);
  CHECK_FALSE(address.integer("address", 1, 16).has_value());
  CHECK(parse_address("sim:", {"gcs", "sim"}).place.empty());
}

TEST_CASE("A bad device string is a usage error that names the fault") {
  for (const char* bad :
       {"", "/dev/ttyUSB0", "usb:1", "gcs:/dev/x?baud", "gcs:/dev/x?=1", "gcs:/dev/x?baud=1&baud=2"}) {
    CAPTURE(bad);
    CHECK(fault_of([&] { (void)parse_address(bad, {"gcs", "sim"}); }) == Fault::usage);
  }
  const auto address = parse_address("gcs:/dev/x?bauds=fast&axis=1", {"gcs"});
  CHECK(has(message_of([&] { address.allow({"baud", "axis"}); }), "did you mean baud"));
  CHECK(fault_of([&] { (void)address.number("bauds", 0, 0, 1); }) == Fault::usage);
  const auto half = parse_address("gcs:/dev/x?baud=0.5", {"gcs"});
  CHECK(fault_of([&] { (void)half.integer("baud", 0, 10); }) == Fault::usage);
}

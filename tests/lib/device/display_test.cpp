#include "device/open/display.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <vector>

#include "base/error.hpp"
#include "fault_of.hpp"

using namespace vam;
using namespace vam::device;

TEST_CASE("A screen refuses frames of another size or depth") {
  VirtualClock clock;
  const auto display = open_display("null:", {4, 3, 60}, clock, nullptr);
  CHECK(fault_of([&] { display->add(GreyImage(3, 4, 8)); }) == Fault::data);
  CHECK(fault_of([&] { display->add(GreyImage(4, 3, 10)); }) == Fault::usage);
  GreyImage two(2, 1, 1);
  two(1, 0) = 1;
  CHECK(screen_bytes(two, {2, 1, 60}) == std::vector<std::uint8_t>{0, 255});
  CHECK(fault_of([&] { (void)open_display("hdmi:1", {4, 3, 60}, clock, nullptr); }) == Fault::usage);
}

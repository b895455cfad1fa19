// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/open/open.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::device;

TEST_CASE("A simulated screen flips at the next vertical blank of its clock, and one later where it misses one") {
  VirtualClock clock;
  clock.sleep_until(5);
  const auto sequences = [&](const std::string& device) {
    const auto display = open_display(device, {4, 3, 60}, clock, nullptr);
    CHECK(display->mode().hz == 100);
    CHECK(display->add(GreyImage(4, 3, 8)) == 0);
    CHECK(display->add(GreyImage(4, 3, 1)) == 1);
    const double origin_s = clock.now_s();
    std::vector<long> seen;
    for (const double late_s : {0.0, 0.0, 0.015, 0.0}) {
      clock.sleep_until(clock.now_s() + late_s);
      const Flip flip = display->present(0);
      CHECK(flip.time_s == doctest::Approx(origin_s + 0.01 * static_cast<double>(flip.sequence)).epsilon(1e-12));
      CHECK(clock.now_s() == doctest::Approx(flip.time_s).epsilon(1e-6));
      seen.push_back(flip.sequence);
    }
    return seen;
  };
  CHECK(sequences("null:?hz=100") == std::vector<long>{1, 2, 4, 5});
  CHECK(sequences("null:?hz=100&miss=2") == std::vector<long>{1, 3, 5, 7});
}

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

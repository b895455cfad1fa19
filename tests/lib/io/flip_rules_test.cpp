// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/settings/flip_rules.hpp"

#include "base/text/json.hpp"
#include "testing.hpp"

using vam::Fault;
using vam::Json;
using vam::io::FlipRules;

namespace {

Json flip(double t_s, int frame, double angle_deg) {
  return {{"event", "flip"}, {"t_monotonic_s", t_s}, {"frame", frame}, {"angle_deg", angle_deg}};
}

// Two flips of a print of 3 turns and 60 frames, and what is said of the second.
std::string refusal(const Json& first, const Json& second, FlipRules::Order order = FlipRules::Order::required) {
  FlipRules rules(order);
  rules.note({{"event", "display"}}, "log:1");
  rules.note({{"event", "sinogram"}, {"frames", 60}, {"turns", 3}}, "log:2");
  (void)rules.take(first, "log:3");
  return error_of([&] { (void)rules.take(second, "log:4"); }, Fault::data);
}

}  // namespace

TEST_CASE("numbers that no print has are refused, with their line") {
  const Json first = flip(10, 0, 0);
  const char* remedy = "; the log was changed; restore it";
  CHECK(refusal(first, flip(11, 99999, 6)) ==
        std::string("log:4: frame 99999 is none of the 60 of the print") + remedy);
  CHECK(has(refusal(first, flip(11, 60, 6)), "frame 60 is none of the 60"));
  CHECK(has(refusal(first, flip(11, -2, 6)), "frame -2 is not a whole number from -1 to"));
  CHECK(has(refusal(first, flip(1e308, 1, 6)), "log:4: time 1e+308 s is not between 0 and 1e+09 s"));
  CHECK(has(refusal(first, flip(-1, 1, 6)), "time -1 s"));
  CHECK(
      has(refusal(first, flip(11, 1, -1000)), "angle -1000 deg is not between 0 and 1080 deg, where images are shown"));
  CHECK(has(refusal(first, flip(11, 1, 1081)), "angle 1081 deg"));
  CHECK(has(refusal(first, flip(11, -1, 1e300)), "angle 1e+300 deg"));
  Json half = flip(11, 1, 6);
  half["frame"] = 1.5;
  CHECK(has(refusal(first, half), "frame 1.5 is not a whole number"));
  half = flip(11, 1, 6);
  half["missed"] = -1;
  CHECK(has(refusal(first, half), "missed -1"));
  CHECK(has(refusal(first, flip(1e308, 1, 6), FlipRules::Order::free), "time 1e+308 s"));
}

TEST_CASE("flips out of order are refused, unless a hash holds them") {
  const Json first = flip(10, 0, 100);
  CHECK(has(refusal(first, flip(9.5, 1, 106)), "time goes back by 0.5 s"));
  CHECK(has(refusal(first, flip(10.1, 1, 50)), "the angle goes back from 100 to 50 deg"));
  CHECK(has(refusal(first, flip(25, 1, 106)), "the image before stayed on for 15 s"));
  FlipRules rules(FlipRules::Order::free);
  (void)rules.take(first, "log:1");
  CHECK(rules.take(flip(9.5, 1, 50), "log:2").t_s == 9.5);
}

TEST_CASE("blanks that are neither flips nor missed are lines that are gone; a new run counts anew") {
  const auto at = [](long sequence, int frame, long missed) {
    Json line = flip(10 + 0.01 * static_cast<double>(sequence), frame, 0);
    line["sequence"] = sequence;
    line["missed"] = missed;
    return line;
  };
  CHECK(has(refusal(at(5, 0, 0), at(9, 1, 1)), "flips are missing before it (vertical blanks: 2)"));
  FlipRules rules(FlipRules::Order::required);
  (void)rules.take(at(5, 0, 0), "log:1");
  (void)rules.take(at(9, 1, 3), "log:2");
  (void)rules.take(at(20, -1, 0), "log:3");  // dark at the end
  rules.note({{"event", "display"}}, "log:4");
  (void)rules.take(flip(1, 0, 0), "log:5");
  (void)rules.take(at(30, 1, 0), "log:6");
}

TEST_CASE("a stage whose predicted angle trembles, and one that ends its turn, is in order") {
  FlipRules rules(FlipRules::Order::required);
  (void)rules.take(flip(10, 0, 719), "log:1");
  (void)rules.take(flip(10, 1, 718), "log:2");
  (void)rules.take(flip(10.1, -1, 0), "log:3");
  CHECK(rules.take(flip(50, 2, 720), "log:4").angle_deg == 720);
}

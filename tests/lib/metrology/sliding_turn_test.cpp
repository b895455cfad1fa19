// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/ost/sliding_turn.hpp"

#include "testing.hpp"

using namespace vam::metrology;

TEST_CASE("a volume is due after each full turn, of one turn's views") {
  SlidingTurn turn(360);
  int volumes = 0;
  for (int i = 0; i < 3 * 90 + 10; ++i) {
    if (!turn.push({{}, std::fmod(4.0 * i, 360.0), 50 + 0.1 * i})) continue;
    ++volumes;
    CHECK(turn.views().size() == 90);
    CHECK((i + 1) % 90 == 0);
    CHECK(turn.turns() == doctest::Approx(volumes));
    CHECK(turn.turn_s() == doctest::Approx(9));
  }
  CHECK(volumes == 3);
  CHECK(turn.turns() == doctest::Approx((280 * 4) / 360.0));
  CHECK(SlidingTurn(360).turn_s() == 0);
}

TEST_CASE("volumes more often than each turn, and in the opposite direction") {
  SlidingTurn turn(90);
  std::vector<int> due;
  for (int i = 0; i < 180; ++i) {
    if (turn.push({{}, -4.0 * i})) due.push_back(i);
  }
  CHECK(due == std::vector<int>{89, 112, 134, 157, 179});
  CHECK(turn.views().size() == 90);
}

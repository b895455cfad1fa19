// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/compute/parallel.hpp"

#include <atomic>
#include <stdexcept>

#include "testing.hpp"

TEST_CASE("parallel_for visits every index once") {
  std::vector<std::atomic<int>> visits(1000);
  vam::parallel_for(1000, [&](int i) { ++visits[i]; });
  for (const auto& count : visits) CHECK(count == 1);
}

TEST_CASE("parallel_for passes an item's exception on") {
  CHECK_THROWS_AS(vam::parallel_for(10,
                                    [](int i) {
                                      if (i == 7) throw std::runtime_error("7");
                                    }),
                  std::runtime_error);
}

TEST_CASE("set_threads limits and 0 restores") {
  vam::set_threads(1);
  CHECK(vam::threads() == 1);
  vam::set_threads(0);
  CHECK(vam::threads() >= 1);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/conditions.hpp"

#include "testing.hpp"

using vam::model::holds;

TEST_CASE("every relation below, at and above its bound") {
  struct Row {
    const char* relation;
    bool below, at, above;
  };
  constexpr double bound = 0.25;
  for (const Row& row : {Row{"<=", true, true, false}, Row{">=", false, true, true}, Row{"<", true, false, false},
                         Row{">", false, false, true}, Row{"=", false, true, false}}) {
    CAPTURE(row.relation);
    CHECK(holds({"ver", row.relation, bound}, std::nextafter(bound, 0.0)) == row.below);
    CHECK(holds({"ver", row.relation, bound}, bound) == row.at);
    CHECK(holds({"ver", row.relation, bound}, std::nextafter(bound, 1.0)) == row.above);
    CHECK_FALSE(holds({"ver", row.relation, bound}, std::nan("")));
  }
}

TEST_CASE("a clause is a name, a relation of one or two signs and a number") {
  for (const std::string relation : {"<=", ">=", "<", ">", "="}) {
    const auto conditions = vam::model::parse_conditions("pw" + relation + "-0.5", {"pw"});
    REQUIRE(conditions.size() == 1);
    CHECK(conditions[0].name == "pw");
    CHECK(conditions[0].relation == relation);
    CHECK(conditions[0].bound == -0.5);
  }
}

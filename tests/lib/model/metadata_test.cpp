// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/metadata.hpp"

#include "testing.hpp"

using namespace vam;
using namespace vam::model;

TEST_CASE("what a part's own surface shows is read as it was stated") {
  const PartSurface surface{{2.5, 0.125, {1, -2, 3}}, {0, 0, {}}, {4, 0.5, {0.25, 0, 0}}, {0, 0, {}}, 7, 2};
  Metadata metadata;
  state_surface(metadata, surface);
  const auto read = stated_surface(metadata);
  REQUIRE(read);
  CHECK(read->walls.area_mm2 == 2.5);
  CHECK(read->walls.at_mm == std::array<double, 3>{1, -2, 3});
  CHECK(read->blocked.mm == 0.5);
  CHECK(read->solids == 7);
  CHECK(read->specks == 2);
  for (const char* wrong : {"", "1 2 3 4", "1 2 3 4 5 6", "-1 2 3 4 5", "1 x 3 4 5"}) {
    metadata["vam:thin_gaps"] = wrong;
    CHECK_FALSE(stated_surface(metadata));
  }
  metadata.erase("vam:thin_gaps");
  CHECK_FALSE(stated_surface(metadata));
}

TEST_CASE("heights of a stretched volume are those of the part again") {
  TriangleSoup mesh{{{1, 2, 3}}, {}};
  unstretch(mesh, {});
  CHECK(mesh.points[0][2] == 3);
  unstretch(mesh, {{"vam:stretch_z", "1.5"}});
  CHECK(mesh.points[0][2] == 2);
  CHECK(stretch_objection("1.5").empty());
  for (const char* wrong : {"", "nan", "0", "0.09", "11", "-1", "1 mm"}) CHECK_FALSE(stretch_objection(wrong).empty());
}

TEST_CASE("a full scale is above 0, or not stated") {
  CHECK_FALSE(full_scale({}));
  CHECK(full_scale({{"vam:full_scale", "0.5"}}) == 0.5);
  CHECK(shown_turns({{"vam:shown_turns", "3"}}) == 3);
  for (const char* wrong : {"0", "-1", "1e7", "much"})
    CHECK(fault_of([&] { (void)full_scale({{"vam:full_scale", wrong}}); }) == Fault::data);
}

TEST_CASE("an exposure that is found late fits in the place of one that is unknown") {
  Metadata early, late;
  state_exposure(early, 0, 0);
  CHECK_FALSE(full_scale(early));
  CHECK_FALSE(shown_turns(early));
  for (const double value : {1e-6, 0.123456789012, 3.0, 999999.125}) {
    state_exposure(late, 3, value);
    CHECK(shown_turns(late) == 3);
    CHECK(*full_scale(late) == doctest::Approx(value).epsilon(1e-8));
    for (const auto& [name, text] : early) CHECK(late.at(name).size() == text.size());
  }
}

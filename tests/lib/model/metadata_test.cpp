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

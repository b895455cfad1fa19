// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/dose/stray_cure.hpp"

#include "base/text/json.hpp"
#include "testing.hpp"

using namespace vam::model;

TEST_CASE("the covered box holds all voxels above a value, and no more") {
  Volume volume{centred_grid(5, 4, 3, 1), std::vector<float>(60)};
  CHECK(covered_box(volume, 0).high[0] < covered_box(volume, 0).low[0]);
  volume.values[(1 * 4 + 2) * 5 + 3] = 0.5F;
  volume.values[(2 * 4 + 1) * 5 + 3] = 0.6F;
  volume.values[0] = 0.1F;
  const VoxelBox box = covered_box(volume, 0.1F);
  CHECK(box.low == std::array<int, 3>{3, 1, 1});
  CHECK(box.high == std::array<int, 3>{3, 2, 2});
}

TEST_CASE("what lies outside the box is counted against the threshold") {
  StrayDoses doses;
  for (const float dose : {0.1F, 0.5F, 0.79F, 0.81F, 0.9F}) doses.add(dose);
  const StrayCure all = doses.at(0.8);
  CHECK(all.voxels == 5);
  CHECK(all.gelled_voxels == 2);
  CHECK(all.max_dose == doctest::Approx(0.9));
  CHECK(doses.at(0.9001).gelled_voxels == 0);  // above the largest: none, although in its bin
  CHECK(StrayDoses{}.at(0.8).gelled_voxels == 0);
  StrayDoses twice;
  twice.merge(doses);
  twice.merge(doses);
  CHECK(twice.at(0.8).gelled_voxels == 4);
  StrayCure known;  // the threshold is
  known.add(0.7F, 0.8);
  known.add(0.9F, 0.8);
  known.merge(all);
  CHECK(known.voxels == 7);
  CHECK(known.gelled_voxels == 3);
  CHECK(known.max_dose == doctest::Approx(0.9));
  vam::Json report;
  append_json(report, all);
  CHECK(report["outside_gelled_voxels"] == 2);
}

TEST_CASE("a box of voxels has its corners and no more") {
  const VoxelBox box{{1, 2, 3}, {4, 5, 6}};
  CHECK(box.contains(1, 2, 3));
  CHECK(box.contains(4, 5, 6));
  CHECK_FALSE(box.contains(0, 2, 3));
  CHECK_FALSE(box.contains(4, 6, 6));
  CHECK_FALSE(box.contains(4, 5, 7));
  CHECK_FALSE(VoxelBox{}.contains(0, 0, 0));
}

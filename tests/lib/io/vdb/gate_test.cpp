// SPDX-License-Identifier: GPL-3.0-or-later
// What cannot be a part, a weight or a dose is refused with file, voxel and remedy before light is computed from it.
#include "io/vdb/gate.hpp"

#include <openvdb/tools/LevelSetSphere.h>

#include "lib/io/vdb_volumes.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace vam::volumes;

namespace {

// A box of 20 x 30 x 40 voxels, empty but for one voxel.
SparseVolume one_voxel(const std::string& name, float value, double voxel_mm = 0.1) {
  const auto grid = model::centred_grid(20, 30, 40, voxel_mm);
  std::vector<float> values(grid.size(), 0.0F);
  values[(17 * 30 + 9) * 20 + 5] = value;  // voxel (5, 9, 17)
  return filled(name, grid, values);
}

std::string refusal(const SparseVolume& volume, TargetKind target = TargetKind::coverage) {
  return error_of([&] { check_values("a.vdb", volume, target); }, Fault::data);
}

std::string refusal_from_file(SparseVolume& volume) {
  const scratch::Folder folder;
  const std::string path = folder / "a.vdb";
  write_volume(path, volume);
  return error_of([&] { check_values("a.vdb", read_volume(path, "target")); }, Fault::data);
}

}  // namespace

TEST_CASE("coverage is 0 to 1, and one voxel outside is named") {
  for (const std::string name : {"target", "insert"}) {
    CHECK(refusal(one_voxel(name, 1)) == "no error");
    CHECK(refusal(one_voxel(name, 1.00005F)) == "no error");  // by another program's rounding
    for (const float value : {-3.0F, 2.0F, 1e30F, -0.01F, 1.01F}) {
      CAPTURE(value);
      CHECK(has(refusal(one_voxel(name, value)), "a.vdb: grid '" + name + "' has "));
      CHECK(has(refusal(one_voxel(name, value)), " in voxel (5, 9, 17); "));
    }
  }
  CHECK(has(refusal(one_voxel("target", 1e30F)), "1e+30"));
  CHECK(has(refusal(one_voxel("target", 1e30F)), "vam-slice"));
  CHECK(refusal(one_voxel("sdf", -3)) == "no error");
  CHECK(refusal(one_voxel("weight", 50)) == "no error");
  CHECK(has(refusal(one_voxel("weight", -1)), "in voxel (5, 9, 17)"));
  CHECK(has(refusal(one_voxel("dose", -1)), "in voxel (5, 9, 17)"));
  CHECK(has(refusal(one_voxel("dose", 1e30F)), "in voxel (5, 9, 17)"));
}

TEST_CASE("a tile is a value as well") {
  const auto grid = model::centred_grid(64, 64, 64, 0.1);
  CHECK(has(refusal(filled("target", grid, std::vector<float>(grid.size(), 2.0F))), "has 2 in voxel (0, 0, 0)"));
}

TEST_CASE("a grey target is a dose") {
  CHECK(refusal(one_voxel("target", 40), TargetKind::grey) == "no error");
  CHECK(refusal(one_voxel("target", -5e-5F), TargetKind::grey) == "no error");
  CHECK(has(refusal(one_voxel("target", -1), TargetKind::grey), "grey target"));
  CHECK(has(refusal(one_voxel("target", 1e30F), TargetKind::grey), "grey target"));
}

TEST_CASE("level sets, solid backgrounds, metres and micrometres, two grids of one name") {
  const scratch::Folder folder;
  openvdb::initialize();
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(3.0F, {0, 0, 0}, 0.25F);
  sphere->setName("target");
  write_by_openvdb(folder / "sphere.vdb", {sphere});
  CHECK(has(refusal(read_volume(folder / "sphere.vdb", "target")), "is a level set"));
  sphere->setName("surface");
  write_by_openvdb(folder / "sphere.vdb", {sphere});
  CHECK(refusal(read_volume(folder / "sphere.vdb", "surface")) == "no error");

  const SparseVolume solid("target", model::centred_grid(20, 20, 20, 0.1), 1.0F);
  CHECK(has(refusal(solid), "has 1 wherever it stores nothing"));
  const SparseVolume weight("weight", model::centred_grid(20, 20, 20, 0.1), 7.5F);
  CHECK(refusal(weight) == "no error");

  CHECK(has(refusal(one_voxel("target", 1, 1e-4)), "is 0.004 mm long, from voxels of 0.0001 mm; is it in metres?"));
  CHECK(has(refusal(one_voxel("target", 1, 100)), "is 4000 mm long, from voxels of 100 mm; is it in micrometres?"));

  std::vector<SparseVolume> two;
  two.push_back(one_voxel("target", 1));
  two.push_back(one_voxel("insert", 1));
  check_values("-", two);
  two.push_back(one_voxel("target", 0.5F));
  CHECK(has(error_of([&] { check_values("-", two); }, Fault::data), "stdin: grid 'target' occurs twice"));
}

TEST_CASE("data read in passing is checked in the same way") {
  SparseVolume good = one_voxel("target", 1);
  CHECK(refusal_from_file(good) == "no error");
  SparseVolume bad = one_voxel("target", -3);
  CHECK(has(refusal_from_file(bad), "a.vdb: grid 'target' has -3 in voxel (5, 9, 17)"));
  const auto grid = model::centred_grid(64, 64, 64, 0.1);
  SparseVolume tiles = filled("target", grid, std::vector<float>(grid.size(), 2.0F));
  CHECK(has(refusal_from_file(tiles), "has 2 in voxel"));
  SparseVolume solid("target", grid, 1.0F);
  CHECK(has(refusal_from_file(solid), "wherever it stores nothing"));
}

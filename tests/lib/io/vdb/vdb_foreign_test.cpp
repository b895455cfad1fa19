// SPDX-License-Identifier: GPL-3.0-or-later
#include <openvdb/tools/LevelSetSphere.h>

#include <limits>

#include "io/vdb/vdb.hpp"
#include "lib/io/vdb_volumes.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace vam::volumes;
using scratch::spill;
using scratch::status;

TEST_CASE("a target of another program is extended by void, and keeps its position") {
  const scratch::Folder folder;
  openvdb::initialize();
  const auto array =
      openvdb::FloatGrid::create(0.0F);  // as pyopenvdb's copyFromArray and createLinearTransform make it
  array->denseFill(openvdb::CoordBBox({0, 0, 0}, {39, 29, 9}), 1.0F);
  const auto transform = openvdb::math::Transform::createLinearTransform(0.1);
  transform->postTranslate({-1.95, -1.45, 0.05});
  array->setTransform(transform);
  array->setName("target");
  write_by_openvdb(folder / "array.vdb", {array});
  const SparseVolume volume = read_volume(folder / "array.vdb", "target");
  const model::Grid& grid = volume.grid();
  CHECK(grid.nz == 10);
  CHECK(grid.z_mm(0) == doctest::Approx(0.05));
  const double corner_mm = std::hypot(2, 1.5);
  for (const double side : {-grid.x_mm(-0.5), grid.x_mm(grid.nx - 0.5), -grid.y_mm(-0.5), grid.y_mm(grid.ny - 0.5)}) {
    CHECK(side >= corner_mm - 1e-9);
    CHECK(side <= corner_mm + 0.1);
  }
  const auto values = dense(volume);
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value);
  CHECK(sum == 40 * 30 * 10);
  CHECK(by_blocks(folder / "array.vdb", "target") == values);
}

TEST_CASE("a level set of another program is read as its active box, off the index origin, and can be written back") {
  const scratch::Folder folder;
  openvdb::initialize();
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(3.0F, {10.0F, -4.0F, 2.0F}, 0.25F);
  sphere->setName("surface");
  write_by_openvdb(folder / "sphere.vdb", {sphere});
  SparseVolume volume = read_volume(folder / "sphere.vdb", "");
  const auto box = sphere->evalActiveVoxelBoundingBox();
  CHECK(volume.grid().nx == box.dim().x());
  CHECK(volume.grid().voxel_mm == doctest::Approx(0.25));
  const auto check = [&](const SparseVolume& read) {
    const auto values = dense(read);
    const auto accessor = sphere->getConstAccessor();
    std::size_t at = 0;
    std::size_t wrong = 0;
    for (const auto [k, j, i] : indices(read.grid().nz, read.grid().ny, read.grid().nx)) {
      wrong += values[at++] != accessor.getValue(box.min() + openvdb::Coord(i, j, k)) ? 1 : 0;
    }
    CHECK(wrong == 0);
    const openvdb::Vec3d centre = sphere->indexToWorld(box.min());
    CHECK(read.grid().x_mm(0) == doctest::Approx(centre.x()));
    CHECK(read.grid().z_mm(0) == doctest::Approx(centre.z()));
  };
  check(volume);
  write_volume(folder / "again.vdb", volume);
  const SparseVolume again = read_volume(folder / "again.vdb", "surface");
  CHECK(again.grid() == volume.grid());
  check(again);
}

TEST_CASE("metadata that the tools use, but of another type or beyond what they take, are refused") {
  const scratch::Folder folder;
  openvdb::initialize();
  const auto refusal = [&](const char* key, const openvdb::Metadata& stated) {
    const auto grid = openvdb::FloatGrid::create(0.0F);
    grid->denseFill(openvdb::CoordBBox({0, 0, 0}, {3, 3, 3}), 1.0F);
    grid->setName("target");
    grid->insertMeta(key, stated);
    write_by_openvdb(folder / "a.vdb", {grid});
    std::string line;
    CHECK(status([&] { by_blocks(folder / "a.vdb", "target"); }, &line) == 65);
    CHECK(status([&] { read_volume(folder / "a.vdb", "target"); }, &line) == 65);
    return line.substr(line.find("a.vdb: "));
  };
  using Text = openvdb::StringMetadata;
  for (const char* factor : {"nan", "1e9", "0", "tall", "", "-1"}) {
    CHECK(refusal("vam:stretch_z", Text(factor)) == std::string("a.vdb: grid 'target' states vam:stretch_z '") +
                                                        factor +
                                                        "', which is not a factor of 0.1 to 10; slice it again");
  }
  CHECK(refusal("vam:stretch_z", openvdb::DoubleMetadata(1)) ==
        "a.vdb: grid 'target' states vam:stretch_z as double, not as text; slice it again");
  for (const char* key : {"vam:shape", "vam:first_index"}) {
    CHECK(refusal(key, Text("4 4 4")) == std::string("a.vdb: grid 'target' has ") + key +
                                             " as string, not as three integers (vec3i); mend it in the program that "
                                             "wrote it");
  }
}

TEST_CASE("the farthest voxel is found whether it is active or not, in leaves and in tiles") {
  const scratch::Folder folder;
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create();
  grid->setName("target");
  grid->tree().setValue({-20, 0, 0}, 0.0F);  // the box
  grid->tree().setValue({20, 0, 0}, 0.0F);
  grid->tree().setValueOff({6, 8, 0}, 1.0F);
  const auto farthest = [&] {
    write_by_openvdb(folder / "a.vdb", {grid});
    const SparseVolume read = read_volume(folder / "a.vdb", "");
    return farthest_mm(read, 0) / read.grid().voxel_mm;
  };
  CHECK(farthest() == doctest::Approx(10));
  grid->tree().addTile(1, {8, 8, 0}, 1.0F, false);  // 8 x 8 x 8 voxels, inactive
  CHECK(farthest() == doctest::Approx(std::hypot(15, 15)));
  const SparseVolume read = read_volume(folder / "a.vdb", "");
  const auto box = vam::io::covered_box(read, 0);  // of a grid with void around what the file has
  const auto mm = [&](const std::array<int, 3>& at) {
    const auto& place = read.grid();
    return std::array{place.x_mm(at[0]), place.y_mm(at[1]), place.z_mm(at[2])};
  };
  CHECK(mm(box.low) == std::array<double, 3>{6, 8, 0});
  CHECK(mm(box.high) == std::array<double, 3>{15, 15, 7});
  CHECK(vam::io::covered_box(read, 1).high[0] < 0);
}

TEST_CASE("unusable grids are status 65 with the reason") {
  const scratch::Folder folder;
  openvdb::initialize();
  std::string line;
  const auto read = [&](const openvdb::GridPtrVec& grids) {
    write_by_openvdb(folder / "a.vdb", grids);
    const int whole = status([&] { read_volumes(folder / "a.vdb"); }, &line);
    for (const auto& grid : grids) grid->setName("target");
    write_by_openvdb(folder / "a.vdb", grids);
    std::string ignored;
    CHECK((status([&] { by_blocks(folder / "a.vdb", "target"); }, &ignored) == 0) == (whole == 0));
    return whole;
  };
  const auto one_voxel = [](float value) {
    const auto grid = openvdb::FloatGrid::create();
    grid->setName("target");
    grid->tree().setValue({1, 2, 3}, value);
    return grid;
  };
  CHECK(read({one_voxel(1.0F)}) == 0);
  CHECK(read({one_voxel(std::numeric_limits<float>::quiet_NaN())}) == 65);
  CHECK(has(line, "'target' has a value in voxel (4, 5, 0) that is not a finite number; mend it"));
  const auto tile = openvdb::FloatGrid::create();
  tile->tree().addTile(1, {0, 0, 0}, std::numeric_limits<float>::infinity(), true);
  CHECK(read({tile}) == 65);
  CHECK(has(line, "' has a value in voxel (0, 0, 0) that is not a finite"));
  CHECK(read({openvdb::FloatGrid::create()}) == 65);
  CHECK(has(line, "is empty"));
  CHECK(read({openvdb::Vec3SGrid::create()}) == 65);
  CHECK(has(line, "no grid of floats, but"));

  auto turned = one_voxel(1.0F);
  turned->transform().preRotate(0.3);
  CHECK(read({turned}) == 65);
  CHECK(has(line, "rotated"));
  auto stretched = one_voxel(1.0F);
  stretched->transform().preScale({1.0, 1.0, 1.1});
  CHECK(read({stretched}) == 65);
  auto far = one_voxel(1.0F);
  far->tree().setValue({2'000'000'000, 0, 0}, 1.0F);
  CHECK(read({far}) == 65);
  CHECK(has(line, "65536"));
  auto shaped = one_voxel(1.0F);
  shaped->insertMeta("vam:shape", openvdb::Vec3IMetadata({2'000'000'000, 1, 1}));
  CHECK(read({shaped}) == 65);
  // Other grids beside a float grid do not matter.
  CHECK(read({openvdb::Vec3SGrid::create(), one_voxel(1.0F)}) == 0);

  spill(folder / "empty.vdb", "");
  CHECK(status([&] { read_volumes(folder / "empty.vdb"); }) == 65);
  spill(folder / "text.vdb", std::string(1000, 'x'));
  CHECK(status([&] { read_volumes(folder / "text.vdb"); }, &line) == 65);
  CHECK(status([&] { read_volumes(folder / "absent.vdb"); }) == 66);
}

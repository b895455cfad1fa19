// SPDX-License-Identifier: GPL-3.0-or-later
#include <openvdb/tools/LevelSetSphere.h>

#include "io/vdb/private/serialisation.hpp"
#include "lib/io/vdb_volumes.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace vam::volumes;
using scratch::status;

TEST_CASE("blocks equal the slices of the volume") {
  const scratch::Folder folder;
  const auto grid = model::centred_grid(200, 45, 150, 0.065, 0.4);
  std::vector<SparseVolume> volumes;
  volumes.push_back(filled("target", grid, ball(grid)));  // with tiles of 8 and of 128 voxels in it
  volumes.push_back(SparseVolume("insert", grid));
  volumes.push_back(SparseVolume("weight", grid, 7.5F));
  const std::vector<float> slice(grid.slice_size(), -1.0F);
  volumes[2].write_slices(4, 1, slice.data());
  volumes[2].history = {"a line"};
  volumes[2].units = "mJ/cm3";
  volumes[2].metadata["vam:stretch_z"] = "1.037";
  write_volumes(folder / "file.vdb", volumes);
  {
    const scratch::Redirect to(STDOUT_FILENO, folder / "pipe.vdb");
    write_volumes("-", volumes);
    SparseVolume other("tolerance", grid);
    write_volume("-", other);  // a second archive on the same stream
  }
  for (const std::string name : {"target", "insert", "weight"}) {
    CAPTURE(name);
    const auto whole = dense(read_volume(folder / "file.vdb", name));
    CHECK(by_blocks(folder / "file.vdb", name) == whole);
    CHECK(by_blocks(folder / "pipe.vdb", name) == whole);
  }
  const SparseVolume weight = read_volume(folder / "file.vdb", "weight");
  CHECK(weight.grid() == grid);
  CHECK(weight.background() == 7.5F);
  CHECK(weight.history ==
        std::vector<std::string>{"a line", "# sealed " + check_volumes(folder / "file.vdb", true)[2].seal});
  CHECK(weight.units == volumes[2].units);
  CHECK(weight.metadata == volumes[2].metadata);
  CHECK(error_of([&] { by_blocks(folder / "file.vdb", "dose"); }, Fault::data)
            .ends_with("has no grid 'dose'; choose one of target, insert, weight"));
}

TEST_CASE("blocks of other programs: half floats, all octants, tiles of any size, other grids before") {
  const scratch::Folder folder;
  openvdb::initialize();
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(3.0F, {0.3F, -0.4F, 0.2F}, 0.25F);
  sphere->setName("surface");
  sphere->setSaveFloatAsHalf(true);
  sphere->tree().addTile(2, {128, 0, 0}, 2.5F, true);
  const auto before = openvdb::Vec3SGrid::create();
  before->setName("velocity");
  before->tree().setValue({1, 2, 3}, {1, 2, 3});
  write_by_openvdb(folder / "a.vdb", {before, sphere});
  const auto whole = dense(read_volume(folder / "a.vdb", "surface"));
  CHECK(std::count(whole.begin(), whole.end(), 2.5F) == 128 * 128 * 128);
  CHECK(by_blocks(folder / "a.vdb", "surface") == whole);
  CHECK(error_of([&] { by_blocks(folder / "a.vdb", "velocity"); }, Fault::data)
            .ends_with("has no grid 'velocity'; choose one of surface"));
  const auto twin = sphere->copy();  // shares the tree
  twin->setName("twin");
  write_by_openvdb(folder / "twins.vdb", {sphere, twin});
  CHECK(by_blocks(folder / "twins.vdb", "twin") == whole);
  CHECK(by_blocks(folder / "twins.vdb", "surface") == whole);
}

TEST_CASE("a tile of a level that no tree has is taken for one of the nearest level") {
  struct Levels {
    void start(const GridHead&) {}
    void other(const std::string&) {}
    void tile(const TileRecord& tile) { seen.push_back(tile.level); }
    void leaf() {}
    std::vector<std::int32_t> seen;
  } levels;
  read_apart(
      {"a.vdb", 1000},
      [](Sender& out) {
        for (const std::int32_t level : {-2147483647, 0, 1, 2, 3, 4, 2147483647}) {
          out.put(Record::tile);
          out.put(TileRecord{{}, level, 1, 1});
        }
        out.put(Record::end);
      },
      [&](Receiver& in) { receive_records(in, levels); });
  CHECK(levels.seen == std::vector<std::int32_t>{1, 1, 1, 2, 3, 3, 3});
}

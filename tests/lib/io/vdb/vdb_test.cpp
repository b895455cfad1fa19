// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vdb/vdb.hpp"

#include <sys/stat.h>

#include <limits>
#include <thread>

#include "base/compute/parallel.hpp"
#include "lib/io/vdb_volumes.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::io;
using namespace vam::volumes;
using scratch::slurp;
using scratch::spill;
using scratch::status;

TEST_CASE("slices come back as they were written, for shapes that are no multiples of 8") {
  for (const auto& grid : {model::centred_grid(64, 64, 64, 0.1), model::centred_grid(61, 45, 37, 0.1),
                           model::centred_grid(1, 1, 1, 0.1), model::centred_grid(9, 3, 100, 0.1)}) {
    CAPTURE(grid.nx);
    const auto values = ball(grid);
    CHECK(dense(filled("target", grid, values)) == values);
    CHECK(dense_volume(filled("target", grid, values)).values == values);
    CHECK(dense_volume(filled("target", grid, values)).grid == grid);
    // In odd portions, from the top down, as no tool would do it.
    SparseVolume volume("target", grid);
    for (int k = grid.nz; k > 0;) {
      const int count = std::min(k, 5);
      k -= count;
      volume.write_slices(k, count, values.data() + static_cast<std::size_t>(k) * grid.slice_size());
    }
    CHECK(dense(volume) == values);
    for (int k = 0; k < grid.nz; k += 3) {
      std::vector<float> slice(grid.slice_size());
      volume.read_slices(k, 1, slice.data());
      CHECK(std::equal(slice.begin(), slice.end(), values.begin() + k * static_cast<std::ptrdiff_t>(slice.size())));
    }
  }
}

TEST_CASE("slices can be overwritten, also with background") {
  const auto grid = model::centred_grid(40, 40, 24, 0.1);
  auto values = ball(grid);
  SparseVolume volume = filled("target", grid, values);
  const std::vector<float> ones(grid.slice_size() * 12, 1.0F);
  const std::vector<float> zeros(grid.slice_size() * 8, 0.0F);
  volume.write_slices(3, 12, ones.data());
  volume.write_slices(8, 8, zeros.data());
  std::copy(ones.begin(), ones.end(), values.begin() + 3 * static_cast<std::ptrdiff_t>(grid.slice_size()));
  std::copy(zeros.begin(), zeros.end(), values.begin() + 8 * static_cast<std::ptrdiff_t>(grid.slice_size()));
  CHECK(dense(volume) == values);
  volume.prune();
  CHECK(dense(volume) == values);
}

TEST_CASE("several threads read at once") {
  const auto grid = model::centred_grid(50, 50, 64, 0.1);
  const auto values = ball(grid);
  const SparseVolume volume = filled("target", grid, values);
  std::vector<float> out(values.size());
  parallel_for(grid.nz,
               [&](int k) { volume.read_slices(k, 1, out.data() + static_cast<std::size_t>(k) * grid.slice_size()); });
  CHECK(out == values);
}

TEST_CASE("unwritten voxels have the background value, also other than 0") {
  const auto grid = model::centred_grid(20, 20, 20, 0.1);
  SparseVolume volume("sdf", grid, 7.5F);
  CHECK(dense(volume) == std::vector<float>(grid.size(), 7.5F));
  const std::vector<float> slice(grid.slice_size(), -1.0F);
  volume.write_slices(4, 1, slice.data());
  const auto out = dense(volume);
  CHECK(out[grid.slice_size() * 4] == -1.0F);
  CHECK(out[grid.slice_size() * 5] == 7.5F);
}

TEST_CASE("facts and voxels survive a file and a pipe") {
  const scratch::Folder folder;
  auto grid = model::centred_grid(61, 45, 37, 0.065, 0.4);
  const auto values = ball(grid);
  std::vector<SparseVolume> volumes;
  volumes.push_back(filled("target", grid, values));
  volumes.push_back(SparseVolume("insert", grid));
  volumes[0].history = {"vam-slice 0.1.0 part.stl", "second line"};
  volumes[0].metadata["vam:stretch_z"] = "1.037";
  volumes[1].units = "mJ/cm3";
  for (const bool piped : {false, true}) {
    CAPTURE(piped);
    const std::string path = folder / (piped ? "piped.vdb" : "file.vdb");
    if (piped) {
      const scratch::Redirect to(STDOUT_FILENO, path);
      write_volumes("-", volumes);
    } else {
      write_volumes(path, volumes);
    }
    const auto read = read_volumes(path);
    REQUIRE(read.size() == 2);
    CHECK(read[0].name() == "target");
    CHECK(read[0].grid().nx == grid.nx);
    CHECK(read[0].grid().ny == grid.ny);
    CHECK(read[0].grid().nz == grid.nz);
    CHECK(read[0].grid().voxel_mm == grid.voxel_mm);
    CHECK(read[0].grid().origin_mm == grid.origin_mm);
    auto history = volumes[0].history;
    REQUIRE(read[0].history.size() == 3);
    CHECK(read[0].history[2].size() == std::string("# sealed 0123456789abcdef").size());
    history.push_back(read[0].history[2]);
    CHECK(read[0].history == history);
    CHECK(read[0].metadata == volumes[0].metadata);
    CHECK(read[0].units == "relative");
    CHECK(dense(read[0]) == values);
    CHECK(read[1].units == "mJ/cm3");
    CHECK(dense(read[1]) == std::vector<float>(grid.size(), 0.0F));  // empty, but of the shape it was made with

    const auto judge = by_openvdb(path, "target");
    CHECK(judge->getGridClass() == openvdb::GRID_FOG_VOLUME);
    const openvdb::Vec3d corner = judge->indexToWorld(openvdb::Coord(0));
    CHECK(corner.z() == doctest::Approx(0.4));
    const auto accessor = judge->getConstAccessor();
    std::size_t wrong = 0;
    for (const auto [k, j, i] : indices(grid.nz, grid.ny, grid.nx)) {
      const float wanted =
          values[(static_cast<std::size_t>(k) * 45 + static_cast<std::size_t>(j)) * 61 + static_cast<std::size_t>(i)];
      const openvdb::Coord at(i, j, k);
      wrong += accessor.getValue(at) != wanted || accessor.isValueOn(at) != (wanted != 0) ? 1 : 0;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("solid interiors are tiles") {
  const scratch::Folder folder;
  const auto grid = model::centred_grid(128, 128, 128, 0.1);
  SparseVolume volume = filled("target", grid, ball(grid));
  write_volume(folder / "a.vdb", volume);
  const auto judge = by_openvdb(folder / "a.vdb", "target");
  // A ball of radius 57.6 cuts about 4 pi r^2 / 64 * 1.5 leaves; the 2,400 in its interior must be none of them.
  CHECK(judge->tree().leafCount() < 1100);
  CHECK(judge->tree().activeTileCount() > 500);
  CHECK(volume.name() == "target");  // still usable
}

TEST_CASE("the same volume gives the same bytes, whatever the number of threads") {
  const scratch::Folder folder;
  const auto grid = model::centred_grid(60, 60, 60, 0.1);
  for (const int count : {1, 2}) {
    set_threads(count);
    SparseVolume volume = filled("target", grid, ball(grid));
    volume.history = {"a"};
    write_volume(folder / std::to_string(count), volume);
  }
  set_threads(0);
  CHECK(slurp(folder / "1") == slurp(folder / "2"));
  SparseVolume other = filled("target", grid, ball(grid));
  other.history = {"b"};
  write_volume(folder / "3", other);
  CHECK(slurp(folder / "1").substr(21, 36) != slurp(folder / "3").substr(21, 36));  // the archive's UUID
}

TEST_CASE("a volume that is shown has the voxels and the seal of one that is copied") {
  const scratch::Folder folder;
  const model::Grid grid = model::centred_grid(27, 16, 13, 0.1);
  const auto values = ball(grid);
  auto copied = filled("scatter", grid, values);
  SparseVolume shown("scatter", grid);
  shown.show(values.data());
  CHECK(dense(shown) == values);
  write_volume(folder / "copied", copied);
  write_volume(folder / "shown", shown);
  CHECK(dense(read_volume(folder / "shown", "scatter")) == values);
  CHECK(check_volumes(folder / "shown", false).front().seal == check_volumes(folder / "copied", false).front().seal);
}

TEST_CASE("several archives on one stream are read as one") {
  const scratch::Folder folder;
  const auto grid = model::centred_grid(10, 10, 10, 0.1);
  SparseVolume target = filled("target", grid, ball(grid));
  SparseVolume weight("weight", grid, 1.0F);
  write_volume(folder / "a.vdb", target);
  write_volume(folder / "b.vdb", weight);
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  std::thread cat([&] { spill(folder / "pipe", slurp(folder / "a.vdb") + slurp(folder / "b.vdb")); });
  const auto volumes = read_volumes(folder / "pipe");
  cat.join();
  REQUIRE(volumes.size() == 2);
  CHECK(dense(volumes[0]) == ball(grid));
  CHECK(dense(volumes[1]) == std::vector<float>(grid.size(), 1.0F));
}

TEST_CASE("a grid is chosen by name") {
  const scratch::Folder folder;
  const auto grid = model::centred_grid(10, 10, 10, 0.1);
  std::vector<SparseVolume> volumes;
  volumes.push_back(filled("target", grid, ball(grid)));
  volumes.push_back(SparseVolume("weight", grid, 1.0F));
  write_volumes(folder / "a.vdb", volumes);
  CHECK(read_volume(folder / "a.vdb", "weight").name() == "weight");
  std::string line;
  CHECK(status([&] { read_volume(folder / "a.vdb", "dose"); }, &line) == 65);
  CHECK(line.ends_with("a.vdb: has no grid 'dose'; choose one of target, weight"));
  CHECK(status([&] { read_volume(folder / "a.vdb", ""); }, &line) == 65);
  CHECK(line.ends_with("choose one by name"));
}

TEST_CASE("wrong use and a full device are different errors") {
  const scratch::Folder folder;
  const auto grid = model::centred_grid(10, 10, 10, 0.1);
  SparseVolume volume = filled("target", grid, ball(grid));
  std::vector<float> slice(grid.slice_size(), std::numeric_limits<float>::quiet_NaN());
  CHECK(status([&] { volume.write_slices(0, 1, slice.data()); }) == 70);
  CHECK(status([&] { volume.read_slices(9, 2, slice.data()); }) == 70);
  CHECK(status([&] { SparseVolume("target", model::centred_grid(0, 1, 1, 0.1)); }) == 70);
  CHECK(status([&] { write_volume("/dev/full", volume); }) == 74);
  CHECK(status([&] { write_volume(folder / "absent/a.vdb", volume); }) == 73);
  CHECK(folder.count() == 0);
}

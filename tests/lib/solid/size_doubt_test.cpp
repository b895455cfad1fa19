// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of walls, rods and gaps that voxels are too coarse for.
#include "solid/voxel/size_doubt.hpp"

#include <algorithm>

#include "testing.hpp"

using namespace vam;
using namespace vam::solid;

namespace {

constexpr int size = 40;
constexpr double voxel_mm = 0.2;
const model::Grid grid = model::centred_grid(size, size, size, voxel_mm, 0);  // z of slice k is 0.2 k mm

using Coverage = std::function<double(int x, int y, int z)>;

/// A block of 20^3 voxels in the low corner, a voxel from the border, and beside it what is asked for.
verdict::SubVoxelFeatures beside_block(const Coverage& coverage) {
  std::vector<float> values;
  for (const auto [z, y, x] : indices(size, size, size)) {
    const auto in = [](int i) { return i >= 1 && i <= 20; };
    values.push_back(in(x) && in(y) && in(z) ? 1.0F : static_cast<float>(coverage(x, y, z)));
  }
  verdict::SubVoxelFinder finder(grid);
  finder.add(size, values.data());
  return finder.found();
}

std::vector<std::string> doubts(const verdict::SubVoxelFeatures& unresolved, double stretch_z = 1) {
  return resolution_doubts("a.stl", unresolved, grid, stretch_z);
}

bool tells_gaps(const verdict::SubVoxelFeatures& unresolved) {
  const std::vector<std::string> all = doubts(unresolved);
  return std::any_of(all.begin(), all.end(), [](const std::string& doubt) { return has(doubt, "too narrow"); });
}

/// A wall of that thickness in voxels, five slices high, free of the block.
verdict::SubVoxelFeatures wall(double thick, int long_voxels) {
  return beside_block(
      [=](int x, int y, int z) { return x == 30 && y < long_voxels && z >= 10 && z < 15 ? thick : 0.0; });
}

/// A rod along z of that area in voxels, so many slices high.
verdict::SubVoxelFeatures rod(double area, int from, int slices) {
  return beside_block(
      [=](int x, int y, int z) { return x == 30 && y == 30 && z >= from && z < from + slices ? area : 0.0; });
}

/// A second block beside the first, across a gap of that width along x in one column of voxels, `high` voxels along y
/// and z.
verdict::SubVoxelFeatures gap(double wide, int high) {
  return beside_block([=](int x, int y, int z) {
    const auto in = [](int i) { return i >= 1 && i <= 20; };
    if (!in(y) || !in(z) || x < 21 || x > 30) return 0.0;
    const bool there = y >= 8 && y < 8 + high && z >= 8 && z < 8 + high;
    return x == 21 && there ? 1 - wide : 1.0;
  });
}

}  // namespace

TEST_CASE("nothing is said of a part that its voxels resolve") {
  CHECK(doubts(beside_block([](int, int, int) { return 0.0; })).empty());
  CHECK(doubts(wall(0.6, 20)).empty());
  CHECK(doubts(rod(0.6, 5, 30)).empty());
}

TEST_CASE("walls are told from a thousandth of the part on, with their share, heights and the voxels that show them") {
  // 0.4 of 5 slices: a thousandth of 20^3 is 4 voxels long.
  const std::vector<std::string> much = doubts(wall(0.4, 6));
  REQUIRE(much.size() == 1);
  CHECK(
      much[0] ==
      "a.stl: 0.15 % of the part is in walls too thin for the voxels: between z = 1.9 and 2.9 mm no voxel of theirs is "
      "half covered, and they will not be printed; voxels of 0.08 mm or thicker walls may help");
  CHECK(has(doubts(wall(0.4, 6), 1.25)[0], "between z = 1.52 and 2.32 mm"));
  // A wall that stands beside the block, so that it counts by its share alone.
  const auto at_block = [](int long_voxels) {
    return beside_block(
        [=](int x, int y, int z) { return x == 22 && y >= 5 && y < 5 + long_voxels && z >= 10 && z < 15 ? 0.4 : 0.0; });
  };
  CHECK(at_block(3).lost_walls.voxels > 5);
  CHECK(doubts(at_block(3)).empty());
  CHECK(doubts(at_block(5)).size() == 1);
}

TEST_CASE("rods are told from two voxels that are far from all half covered ones, however little of the part") {
  CHECK(doubts(rod(0.16, 10, 12)).empty());
  const std::vector<std::string> thin = doubts(rod(0.16, 10, 13));
  REQUIRE(thin.size() == 1);
  // A square rod of 0.16 voxels of area is 0.4 voxels thick.
  CHECK(thin[0] ==
        "a.stl: walls or rods are too thin for the voxels: between z = 1.9 and 4.5 mm no voxel of theirs is half "
        "covered, "
        "and they will not be printed; voxels of 0.08 mm or thicker walls may help");
}

TEST_CASE("the part's own surface names thickness and place, and keeps silent of what is only rough") {
  model::PartSurface places;
  const auto told = [&](verdict::SubVoxelFeatures unresolved) {
    unresolved.surface = {places, grid.voxel_mm};
    return doubts(unresolved, 1.25);
  };
  CHECK(told(wall(0.4, 6)).empty());
  CHECK(told(gap(0.2, 3)).empty());
  places.relief = {5, 0.11, {1, 2, 3}};
  CHECK(has(told(wall(0.4, 6)).front(), "; voxels of 0.055 mm or thicker walls may help"));
  CHECK(has(told(gap(0.2, 3)).front(), "gaps of 0.11 mm are too narrow"));
  CHECK(told({}) ==
        std::vector<std::string>{"a.stl: ridges and grooves of 0.11 mm are too fine for voxels of 0.2 mm, as "
                                 "near (1, 2, 2.4) mm, and whether they print is not judged; voxels of "
                                 "0.055 mm resolve them"});
  places.walls = {1, 0.35, {1, 2, 3}};
  places.gaps = {1, 0.25, {1, 2, 3}};
  const std::vector<std::string> both = told({});
  REQUIRE(both.size() == 2);
  CHECK(both[0] ==
        "a.stl: walls of 0.35 mm are too fine for voxels of 0.2 mm, as near (1, 2, 2.4) mm, and may not print, as "
        "vam-score "
        "tells; voxels of 0.17 mm resolve them");
  CHECK(has(both[1], "gaps of 0.25 mm are too fine"));
  CHECK(has(both[1], "and whether they print is not judged; voxels of 0.088 mm resolve them"));
  CHECK(has(told(wall(0.4, 6)).front(), "; voxels of 0.17 mm or thicker walls may help"));
  places.gaps = {1, 0.37, {1, 2, 3}};
  CHECK(has(told({})[1], "gaps of 0.37 mm are too fine"));
  CHECK(has(told({})[1], "and may be printed shut, as vam-score tells; voxels of 0.18 mm"));
  places.blocked = {1, 0.41, {1, 2, 3}};
  CHECK(has(told({})[1], "gaps of 0.41 mm are too fine"));
  CHECK(has(told({})[1], "and whether they print is not judged; voxels of 0.14 mm"));
  places = {};
  places.walls = {1, 0.397, {}};  // of a tube, by its facets
  CHECK(told({}).empty());
}

TEST_CASE("gaps are told from a voxel, a tenth of one a slice and a twentieth of a voxel of width on") {
  const std::string wide = doubts(gap(0.2, 3)).at(0);
  CHECK(wide ==
        "a.stl: gaps of 0.04 mm are too narrow for the voxels: between z = 1.5 and 2.1 mm no voxel of theirs is more "
        "than "
        "three quarters free, and they will be printed shut; voxels of 0.02 mm resolve them");
  CHECK(gap(0.2, 2).lost_gaps.voxels == doctest::Approx(0.8));
  CHECK_FALSE(tells_gaps(gap(0.2, 2)));
  CHECK(gap(0.04, 10).lost_gaps.voxels == doctest::Approx(4));
  CHECK_FALSE(tells_gaps(gap(0.04, 10)));
  CHECK(tells_gaps(gap(0.06, 10)));
  const auto slit = [](double free) {  // one voxel a slice
    return beside_block([=](int x, int y, int z) {
      const auto in = [](int i) { return i >= 1 && i <= 20; };
      if (!in(y) || !in(z) || x < 21 || x > 30) return 0.0;
      return x == 25 && y == 10 && z >= 3 && z <= 18 ? 1 - free : 1.0;
    });
  };
  CHECK(slit(0.09).lost_gaps.voxels == doctest::Approx(16 * 0.09));
  CHECK_FALSE(tells_gaps(slit(0.09)));
  CHECK(tells_gaps(slit(0.11)));
}

TEST_CASE(
    "lost walls and shut gaps are told one after the other, and much that is not judged where there are neither") {
  verdict::SubVoxelFeatures both = wall(0.4, 6);
  both.lost_gaps = gap(0.2, 3).lost_gaps;
  const std::vector<std::string> two = doubts(both);
  REQUIRE(two.size() == 2);
  CHECK(has(two[0], "too thin"));
  CHECK(has(two[1], "too narrow"));
  const std::vector<std::string> thin = doubts(wall(0.6, 40));
  CHECK(thin.empty());
  const std::vector<std::string> much =
      doubts(beside_block([](int x, int, int z) { return x >= 28 && x % 4 == 0 && z >= 10 && z < 15 ? 0.6 : 0.0; }));
  REQUIRE(much.size() == 1);
  CHECK(
      much[0].find("a.stl: 4.31 % of the part is in walls or gaps too thin for the voxels: between z = 1.9 and 2.9 mm "
                   "no voxel of theirs is wholly inside or outside") == 0);
}

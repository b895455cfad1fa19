// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/voxel/wall.hpp"

#include "solid/voxel/private/neck.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

model::Volume filled(int nx, int ny, int nz, const std::function<bool(int, int, int)>& inside) {
  model::Volume volume{{nx, ny, nz, 1.0, {}}, {}};
  for (const auto [k, j, i] : indices(nz, ny, nx)) volume.values.push_back(inside(i, j, k) ? 1.0F : 0.0F);
  return volume;
}

double thinnest(const model::Volume& part) { return *solid::walls(part).thinnest_voxels; }

/// An edge along y, of that angle: k of them from the top, on a plate of `plate` slices that is wider.
model::Volume roof(double angle_deg, int plate) {
  const double slope = std::tan(0.5 * angle_deg * std::numbers::pi / 180);
  return filled(60, 30, 50, [=](int i, int, int k) { return k < plate || std::abs(i - 29.5) < slope * (48 - k); });
}

}  // namespace

TEST_CASE("the thinnest wall of plates, also where a thick block stands on one, and across the axes") {
  for (const int n : {1, 2, 3, 4, 7, 8}) {
    const auto plate = filled(30, 30, 12, [n](int, int, int k) { return k >= 2 && k < 2 + n; });
    CHECK(thinnest(plate) == doctest::Approx(n).epsilon(0.2 / n));  // steps of a quarter
    const auto upright = filled(12, 40, 40, [n](int i, int, int) { return i >= 1 && i < 1 + n; });
    CHECK(thinnest(upright) == doctest::Approx(n).epsilon(0.2 / n));
  }
  const auto block_on_plate =
      filled(40, 40, 24, [](int i, int j, int k) { return k < 3 || (i > 10 && i < 28 && j > 10 && j < 28); });
  CHECK(thinnest(block_on_plate) == doctest::Approx(3).epsilon(0.1));
  const auto tilted = filled(60, 60, 20, [](int i, int j, int) { return std::abs(i - j) <= 5; });
  CHECK(std::abs(thinnest(tilted) - 11 / std::sqrt(2.0)) < 1);  // good to a voxel
}

TEST_CASE("the thinnest place of an hourglass is its neck, which a cone has not") {
  for (const double radius : {1.0, 1.5, 2.0}) {
    CAPTURE(radius);
    for (const double tilt : {0.0, 0.2}) {
      const auto hourglass = filled(41, 31, 31, [=](int i, int j, int k) {
        const double x = i - 20;
        return std::abs(x) < 18 && std::hypot(j - 15 - tilt * x, k - 15) <= radius + 0.5 * std::abs(x);
      });
      const solid::Walls found = solid::walls(hourglass);
      const auto& place = found.thinnest_place;  // none where the neck is as much as one in a hundred places
      CHECK(std::abs((place ? place->voxels : *found.thinnest_voxels) - 2 * radius) <= 1);
      REQUIRE((place || tilt > 0));
      if (place) CHECK(std::abs(place->at_mm[0] - 20) <= 2);
    }
  }
  const auto cone = filled(41, 31, 31, [](int i, int j, int k) { return std::hypot(j - 15, k - 15) < 0.35 * i; });
  CHECK(!solid::walls(cone).thinnest_place);
}

TEST_CASE("a neck is narrow, and narrower than both sides, which it joins") {
  const auto found = [](const std::vector<std::int32_t>& row, std::int32_t most, double least_deeper) {
    const int length = static_cast<int>(row.size());
    std::vector<std::int32_t> squared(9 * row.size(), 0);  // the row, with void around it
    std::copy(row.begin(), row.end(), squared.begin() + 4 * length);
    std::vector<std::int64_t> at = solid::necks({length, 3, 3}, squared, most, least_deeper);
    for (std::int64_t& voxel : at) voxel -= 4 * length;
    return at;
  };
  using Places = std::vector<std::int64_t>;
  CHECK(found({0, 9, 4, 9, 0}, 6, 1) == Places{2});
  CHECK(found({0, 9, 4, 9, 0}, 6, 1.1).empty());  // not narrower by so much
  CHECK(found({0, 9, 4, 9, 0}, 3, 1).empty());    // not so narrow
  CHECK(found({0, 9, 4, 4, 1, 4, 0}, 6, 1) == Places{4});
  CHECK(found({0, 9, 4, 1, 0}, 6, 1).empty());     // a tip
  CHECK(found({0, 9, 1, 0, 9, 0}, 6, 1).empty());  // apart
  CHECK(found({0, 0, 0}, 6, 1).empty());
}

TEST_CASE("the thinnest place: one strut between thick blocks, its middle, and no single place") {
  for (const int n : {1, 2, 3, 4, 5, 6}) {
    CAPTURE(n);
    const auto joined = filled(90, 90, 56, [n](int i, int j, int k) {
      return k < 20 || k >= 36 || (i >= 12 && i < 12 + n && j >= 27 && j < 27 + n);
    });
    const solid::Walls found = solid::walls(joined, 1.25);
    CHECK(*found.thinnest_voxels > 10);  // of the blocks
    REQUIRE(found.thinnest_place);
    CHECK(found.thinnest_place->voxels == doctest::Approx(n).epsilon(0.5 / n));
    CHECK(found.thinnest_place->mm == doctest::Approx(found.thinnest_place->voxels));  // level ways
    const auto& at = found.thinnest_place->at_mm;
    CHECK(std::abs(at[0] - (12 + 0.5 * (n - 1))) <= 0.5);
    CHECK(std::abs(at[1] - (27 + 0.5 * (n - 1))) <= 0.5);
    CHECK(at[2] * 1.25 >= 20);
    CHECK(at[2] * 1.25 < 36);
  }
  const auto block = filled(40, 40, 40, [](int i, int j, int k) {
    return (i < 30 && j < 30 && k < 30) || (i == 15 && j == 15 && k == 31);  // a speck
  });
  const solid::Walls plain = solid::walls(block);
  CHECK(!plain.thinnest_place);
}

TEST_CASE("walls of a stretched target in mm of the print") {
  constexpr double stretch = 1.25;
  auto plate = filled(30, 30, 16, [](int, int, int k) { return k >= 2 && k < 12; });
  plate.grid.voxel_mm = 0.1;
  const solid::Walls level = solid::walls(plate, stretch);
  CHECK(*level.thinnest_voxels == doctest::Approx(10).epsilon(0.02));
  CHECK(level.thinnest_mm == doctest::Approx(0.1 * *level.thinnest_voxels / stretch));
  auto upright = filled(16, 40, 40, [](int i, int, int) { return i >= 1 && i < 11; });
  upright.grid.voxel_mm = 0.1;
  CHECK(solid::walls(upright, stretch).thinnest_mm == doctest::Approx(1).epsilon(0.02));
}

TEST_CASE("a ball is as thick as its diameter: its rim is no wall") {
  const auto ball = filled(25, 25, 25, [](int i, int j, int k) { return std::hypot(i - 12, j - 12, k - 12) <= 10; });
  // Half of a voxel's diagonal at either end, and a step.
  CHECK(std::abs(thinnest(ball) - 21) < std::sqrt(3.0) + 0.25);
  CHECK(!solid::walls(filled(4, 4, 4, [](int, int, int) { return false; })).thinnest_voxels);
}

TEST_CASE("the edge of a wedge is no wall, but sharp; nor is a cone's tip") {
  for (const double angle_deg : {30.0, 40.0, 55.0}) {
    const solid::Walls of_roof = solid::walls(roof(angle_deg, 6));
    CHECK(*of_roof.thinnest_voxels == doctest::Approx(6).epsilon(0.2 / 6));  // of the plate, in steps of a quarter
    CHECK(of_roof.sharp_edges);
  }
  // Without walls, the ball that touches base and flanks: of radius r = (h - r) sin(20 deg), h = 48.5.
  const double sine = std::sin(20 * std::numbers::pi / 180);
  CHECK(std::abs(thinnest(roof(40, 0)) - 2 * 48.5 * sine / (1 + sine)) < std::sqrt(3.0));
  const auto cone =
      filled(41, 41, 60, [](int i, int j, int k) { return std::hypot(i - 20, j - 20) < 0.35 * (58 - k); });
  CHECK(thinnest(cone) > 20);
  CHECK(solid::walls(cone).sharp_edges);
}

TEST_CASE("what is as thick everywhere has no sharp edges, however it stands") {
  CHECK(!solid::walls(filled(30, 30, 12, [](int, int, int k) { return k >= 2 && k < 4; })).sharp_edges);
  CHECK(!solid::walls(filled(60, 60, 20, [](int i, int j, int) { return std::abs(i - j) <= 3; })).sharp_edges);
  CHECK(!solid::walls(filled(60, 60, 20, [](int i, int j, int) { return std::abs(3 * i - 2 * j) <= 3; })).sharp_edges);
  CHECK(!solid::walls(filled(25, 25, 25, [](int i, int j, int k) {
           return std::hypot(i - 12, j - 12, k - 12) <= 10;
         })).sharp_edges);
}

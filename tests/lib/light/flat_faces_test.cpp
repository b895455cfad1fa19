// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/flat_faces.hpp"

#include "testing.hpp"

using namespace vam;
using namespace vam::light;

namespace {

/// A disc of radius_px in the slices [first, last) of a grid 60 voxels wide and 20 high, on a stem of 3 x 3.
std::vector<FlatFace> faces_of_table(const model::Grid& grid, double radius_px, int first, int last) {
  FlatFaceFinder finder(grid);
  for (int k = 0; k < grid.nz; ++k) {
    std::vector<float> slice(grid.slice_size(), 0.0F);
    for (const auto [j, i] : indices(grid.ny, grid.nx)) {
      const double x = i - 0.5 * (grid.nx - 1);
      const double y = j - 0.5 * (grid.ny - 1);
      const bool stem = std::abs(x) < 2 && std::abs(y) < 2 && k < last;
      const bool disc = std::hypot(x, y) <= radius_px && k >= first && k < last;
      slice[static_cast<std::size_t>(j) * grid.nx + i] = stem || disc ? 1.0F : 0.0F;
    }
    finder.add(1, slice.data());
  }
  return finder.faces();
}

}  // namespace

TEST_CASE("level faces are found, as high, as large and as wide as they are") {
  const model::Grid grid = model::centred_grid(60, 60, 20, 0.1, 3);
  const auto faces = faces_of_table(grid, 20.5, 8, 12);
  REQUIRE(faces.size() == 2);  // the stem's end is too small
  CHECK(!faces[0].up);
  CHECK(faces[0].z_mm == doctest::Approx(grid.z_mm(7.5)));
  // Between the stem and the rim. Chamfer distances are 6 % too short along diagonals, and voxels are counted whole.
  CHECK(faces[0].width_mm == doctest::Approx(1.8).epsilon(0.12));
  CHECK(faces[1].up);
  CHECK(faces[1].z_mm == doctest::Approx(grid.z_mm(11.5)));
  CHECK(faces[1].width_mm == doctest::Approx(4.1).epsilon(0.12));
  CHECK(faces[1].area_mm2 == doctest::Approx(M_PI * 2.05 * 2.05).epsilon(0.02));
  CHECK(faces_of_table(grid, 20.5, 8, 20).back().z_mm == doctest::Approx(grid.z_mm(19.5)));  // the grid ends on it
}

TEST_CASE("the width of a square is its side, where it is an odd number of voxels from 5 on") {
  const model::Grid grid = model::centred_grid(14, 12, 2, 0.5);
  for (const int side : {2, 3, 4, 5, 7, 9}) {
    CAPTURE(side);
    std::vector<float> slices(2 * grid.slice_size(), 0.0F);
    for (int y = 1; y <= side; ++y) {
      for (int x = 2; x < 2 + side; ++x) slices[y * grid.nx + x] = 1;
    }
    FlatFaceFinder finder(grid);
    finder.add(2, slices.data());
    const auto faces = finder.faces();
    REQUIRE(faces.size() == (side < 5 ? 0 : 2));
    for (const FlatFace& face : faces) {
      CHECK(face.width_mm == doctest::Approx(0.5 * side));  // twice the distance of the middle from what is beside it
      CHECK(face.area_mm2 == doctest::Approx(0.25 * side * side));
    }
  }
}

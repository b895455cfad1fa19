// SPDX-License-Identifier: GPL-3.0-or-later
// Parts from a stack of images.
#include "model/grid.hpp"
#include "solid/voxel/part.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::solid;

TEST_CASE("pixels that all images fill are wholly covered, whatever the stretch, and half ones by their mean") {
  // Three images of 4 x 4 pixels: the left half full, the right half full in the middle one alone.
  const auto read = [](int n) {
    Image image(4, 4);
    for (const auto [y, x] : indices(4, 4)) image(x, y) = x < 2 || n == 1 ? 1.0F : 0.0F;
    return image;
  };
  for (const double stretch_z : {1.0, 1.3, 4.0 / 3}) {
    CAPTURE(stretch_z);
    const Part part = image_part({4, 4, 3, read}, "images", 0.1, stretch_z);
    const model::Grid grid = model::centred_grid(4, 4, 4, 0.1, -0.15);  // z = -0.2 ... 0.2: the stack, stretched by 4/3
    std::vector<float> values;
    const FillSummary seen = fill(part, grid, [&](int, int count, const float* slab) {
      values.insert(values.end(), slab, slab + count * grid.slice_size());
    });
    REQUIRE(values.size() == grid.size());
    const auto at = [&](int x, int k) { return values[(k * 4 + 1) * 4 + x]; };
    CHECK(at(0, 1) == 1.0F);
    CHECK(at(1, 2) == 1.0F);
    // The middle image is 0.1 mm high times the stretch, about z = 0; each of the two slices there holds half of it.
    CHECK(at(2, 1) == doctest::Approx(std::min(1.0, 0.5 * stretch_z)));
    CHECK(at(3, 2) == doctest::Approx(std::min(1.0, 0.5 * stretch_z)));
    CHECK(seen.most == 1.0F);
  }
}

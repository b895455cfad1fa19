// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/slice_place.hpp"

#include "testing.hpp"

using namespace vam;
using optics::SlicePlace;

namespace {

model::Projector projector() { return {.columns = 10, .rows = 8, .pixel_mm = 0.1, .axis_column = 5, .axis_row = 2.5}; }

model::StackInfo slice(int width, int height, double pixel_mm = 0.1) {
  return {.width = width, .height = height, .pixel_mm = pixel_mm, .row_mm = 0.1, .z_start_mm = 1};
}

Image numbered(int width, int height) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.size(); ++i) image.values[i] = static_cast<float>(i + 1);
  return image;
}

}  // namespace

TEST_CASE("a slice is placed with its middle on the axis, moved right and down by the offsets") {
  for (const auto& [right, down] : {std::pair{0, 0}, {2, 1}, {-4, -2}}) {
    const SlicePlace place("part", projector(), slice(3, 2), right, down);
    Image buffer;
    const Image& placed = place.place(numbered(3, 2), 0.25F, buffer);
    REQUIRE(placed.width == 10);
    REQUIRE(placed.height == 8);
    for (const auto [y, x] : indices(8, 10)) {
      const int column = x - 4 - right;  // the middle one is column 5, the axis
      const int row = y - 2 - down;      // the rows 2 and 3 have it between them
      const bool within = column >= 0 && column < 3 && row >= 0 && row < 2;
      CHECK(placed(x, y) == (within ? static_cast<float>(1 + column + 3 * row) : 0.25F));
    }
    model::StackInfo info = slice(3, 2);
    place.apply(info);
    CHECK(info.width == 10);
    CHECK(info.height == 8);
    CHECK(info.z_start_mm == doctest::Approx(1 - 0.1 * (2 + down)));
    GreyImage grey(3, 2, 8);
    for (std::size_t i = 0; i < grey.values.size(); ++i) grey.values[i] = static_cast<std::uint16_t>(i + 1);
    const GreyImage shown = place.place(grey);
    CHECK(shown(4 + right, 2 + down) == 1);
    CHECK(shown(6 + right, 3 + down) == 6);
    CHECK(shown(7 + right, 2 + down) == 0);
  }
}

TEST_CASE("a slice of the image's size stays, one of other pixels or beyond the image is refused") {
  const SlicePlace whole("part", projector(), slice(10, 8));
  Image buffer;
  const Image image = numbered(10, 8);
  CHECK(&whole.place(image, 0, buffer) == &image);
  CHECK(fault_of([] { SlicePlace("part", projector(), slice(10, 8), 1); }) == Fault::data);
  CHECK(fault_of([] { SlicePlace("part", projector(), slice(3, 2), 3); }) == std::nullopt);  // to the last column
  CHECK(fault_of([] { SlicePlace("part", projector(), slice(3, 2), 4); }) == Fault::data);
  CHECK(fault_of([] { SlicePlace("part", projector(), slice(3, 2), -4); }) == std::nullopt);
  CHECK(fault_of([] { SlicePlace("part", projector(), slice(3, 2), -5); }) == Fault::data);
  CHECK(fault_of([] { SlicePlace("part", projector(), slice(3, 2), 0, 4); }) == std::nullopt);
  CHECK(fault_of([] { SlicePlace("part", projector(), slice(3, 2), 0, 5); }) == Fault::data);
  CHECK(fault_of([] { SlicePlace("part", projector(), slice(3, 2), 0, -3); }) == Fault::data);
  CHECK(fault_of([] { SlicePlace("part", projector(), slice(3, 2, 0.10005)); }) == std::nullopt);
  CHECK(fault_of([] { SlicePlace("part", projector(), slice(3, 2, 0.1003)); }) == Fault::data);
  CHECK(fault_of([] { SlicePlace("part", projector(), slice(3, 2, 0)); }) == std::nullopt);  // not known
}

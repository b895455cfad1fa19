// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/cure/bodies.hpp"

#include <numeric>

#include "solid/voxel/isosurface.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

void put(model::Volume& volume, const std::array<int, 3>& low, const std::array<int, 3>& size, float value) {
  for (int k = low[2]; k < low[2] + size[2]; ++k) {
    for (int j = low[1]; j < low[1] + size[1]; ++j) {
      for (int i = low[0]; i < low[0] + size[0]; ++i) volume.slice(k)[j * volume.grid.nx + i] = value;
    }
  }
}

double sum(const model::Volume& volume) { return std::accumulate(volume.values.begin(), volume.values.end(), 0.0); }

model::Volume scene() {
  const model::Grid grid = model::centred_grid(40, 30, 20, 0.5);
  model::Volume volume{grid, std::vector<float>(grid.size())};
  put(volume, {2, 2, 2}, {20, 10, 10}, 1);   // 2000 voxels, 250 mm3
  put(volume, {22, 12, 12}, {1, 1, 1}, 1);   // touches it by a corner
  put(volume, {30, 2, 2}, {5, 5, 2}, 1);     // 50 voxels, 2.5 % of the largest
  put(volume, {30, 20, 10}, {3, 3, 2}, 1);   // 18 voxels, 0.9 %
  put(volume, {5, 4, 4}, {2, 2, 2}, 0.2F);   // a cavity below resolution
  put(volume, {12, 4, 4}, {4, 4, 4}, 0.2F);  // one above
  return volume;
}

}  // namespace

TEST_CASE("bodies of less than a hundredth of the largest are dropped, cavities below resolution filled") {
  model::Volume volume = scene();
  const BodyCount count = keep_bodies(volume, 0.5, {});
  CHECK(count.kept == 2);
  CHECK(count.dropped == 1);
  CHECK(count.dropped_mm3 == doctest::Approx(18 * 0.125));
  CHECK(count.largest_dropped_mm3 == doctest::Approx(18 * 0.125));
  CHECK(count.kept_mm3 == doctest::Approx((2000 + 1 - 8 - 64 + 50) * 0.125));
  CHECK(count.filled == 1);
  const auto above = std::count_if(volume.values.begin(), volume.values.end(), [](float v) { return v >= 0.5F; });
  CHECK(above == 2000 + 1 - 64 + 50);
}

TEST_CASE("where a print reaches the end of the volume is named") {
  const model::Grid grid = model::centred_grid(41, 41, 20, 0.5);
  const auto cut = [&](const std::array<int, 3>& low, const std::array<int, 3>& size) {
    model::Volume volume{grid, std::vector<float>(grid.size())};
    put(volume, low, size, 1);
    return cut_sides(volume, 0.5);
  };
  using Sides = std::vector<std::string>;
  CHECK(cut({10, 10, 1}, {20, 20, 18}).empty());
  CHECK(cut({10, 10, 1}, {20, 20, 19}) == Sides{"top"});
  CHECK(cut({10, 10, 0}, {20, 20, 20}) == Sides{"top", "bottom"});
  CHECK(cut({20, 20, 5}, {19, 1, 1}).empty());
  CHECK(cut({20, 20, 5}, {20, 1, 1}) == Sides{"side"});
  CHECK(cut({5, 5, 5}, {1, 1, 1}) == Sides{"side"});  // beyond the circle that is seen from all sides
}

TEST_CASE("the smallest body, and the neighbourhood of a reference, can be set") {
  model::Volume volume = scene();
  CHECK(keep_bodies(volume, 0.5, {.least_mm3 = 0, .inside = {}}).kept == 3);
  volume = scene();
  CHECK(keep_bodies(volume, 0.5, {.least_mm3 = 7, .inside = {}}).kept == 1);
  const model::Grid grid = model::centred_grid(20, 15, 10, 1, 0.25);
  model::Volume reference{grid, std::vector<float>(grid.size())};
  put(reference, {15, 1, 1}, {2, 2, 1}, 1);  // about the second body alone
  volume = scene();
  const BodyCount near = keep_bodies(volume, 0.5, {.least_mm3 = {}, .inside = neighbourhood({reference}, 1)});
  CHECK(near.kept == 1);
  CHECK(near.kept_mm3 == doctest::Approx(50 * 0.125));
  put(reference, {15, 1, 1}, {2, 2, 1}, 0);
  CHECK_THROWS_AS((void)neighbourhood({reference}, 1), Error);
}

TEST_CASE("an empty selection is not an error") {
  model::Volume volume{model::centred_grid(4, 4, 4, 1), std::vector<float>(64)};
  const BodyCount count = keep_bodies(volume, 0.5, {});
  CHECK(count.kept == 0);
  CHECK(count.dropped == 0);
  CHECK(sum(volume) == 0);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// What the summary of a filled grid counts.
#include "solid/voxel/part.hpp"

#include "model/dose/dose_metrics.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::solid;

TEST_CASE("a voxel is inside the part, cut by its surface or neither as the figures of a dose take it") {
  const model::Grid grid = model::centred_grid(7, 1, 1, 1, 0);
  const std::vector<float> covered{0, 0.0005F, 0.002F, 0.5F, 0.998F, 0.9995F, 1};
  Part part;
  part.fill = [&](const model::Grid& asked, const SliceSink& sink) {
    CHECK(asked.size() == covered.size());
    sink(0, 1, covered.data());
    return Vote{};
  };
  const FillSummary content = fill(part, grid, [](int, int, const float*) {});
  const auto count = [&](model::Label label) {
    return std::count_if(covered.begin(), covered.end(), [&](float c) { return model::label_of(c) == label; });
  };
  CHECK(content.solid_voxels == count(model::Label::part));
  CHECK(content.surface_voxels == count(model::Label::surface));
  CHECK(content.solid_voxels == 2);
  CHECK(content.surface_voxels == 3);
}

TEST_CASE("a part that is lifted takes its box, its voxels and what its surface shows along") {
  const model::Grid grid = model::centred_grid(1, 1, 3, 1, 0);
  Part part;
  part.extent.box.add({0, 0, -1});
  part.extent.box.add({1, 1, 1});
  part.fill = [&](const model::Grid& asked, const SliceSink&) {
    CHECK(asked.origin_mm[2] == doctest::Approx(grid.origin_mm[2] - 2.5));
    return Vote{};
  };
  part.surface = [&](const model::Grid& asked) {
    CHECK(asked.origin_mm[2] == doctest::Approx(grid.origin_mm[2] - 2.5));
    return model::PartSurface{
        {1, 0.2, {3, 4, 5}}, {2, 0.1, {6, 7, 8}}, {1, 0.1, {0, 0, 1}}, {3, 0.3, {9, 10, 11}}, 2, 1};
  };
  const Part higher = lifted(part, 2.5);
  CHECK(higher.extent.box.low == Vector3{0, 0, 1.5});
  CHECK(higher.extent.box.high == Vector3{1, 1, 3.5});
  CHECK(higher.map.shift[2] == doctest::Approx(part.map.shift[2] + 2.5));
  (void)higher.fill(grid, [](int, int, const float*) {});
  const model::PartSurface surface = higher.surface(grid);
  CHECK(surface.walls.at_mm == Vector3{3, 4, 7.5});
  CHECK(surface.gaps.at_mm == Vector3{6, 7, 10.5});
  CHECK(surface.blocked.at_mm == Vector3{0, 0, 3.5});
  CHECK(surface.relief.at_mm == Vector3{9, 10, 13.5});
  CHECK(surface.solids == 2);
  part.surface = {};
  CHECK(!lifted(part, 1).surface);
}

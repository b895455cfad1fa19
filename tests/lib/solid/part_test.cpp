// SPDX-License-Identifier: GPL-3.0-or-later
// What the summary of a filled grid counts.
#include "solid/voxel/part.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "model/dose_metrics.hpp"

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/simulation/dose_stream.hpp"

#include <cstddef>

#include "base/compute/parallel.hpp"
#include "light/grids/poses.hpp"
#include "light/operators/operator.hpp"
#include "light/simulation/private/simulation_state.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::light;

namespace {

constexpr int slices = 203;  // three blocks and a part, the last slab not full
constexpr int columns = 48;
constexpr int angles = 24;
constexpr double voxel_mm = 0.2;

model::Printer printer() {
  model::Printer p{.projector = {.columns = columns, .rows = 260, .pixel_mm = voxel_mm, .axis_column = 23.5}};
  p.projector.axis_row = 200;  // most of the part far above the lens's axis: rays climb by 10 slices
  p.projector.lens_distance_mm = 60;
  p.vial.radius_mm = 5;
  return p;
}

model::StackInfo stack(int rows) {
  model::StackInfo info;
  info.space = model::Space::projector;
  info.width = columns;
  info.height = angles;
  info.count = rows;
  info.pixel_mm = info.row_mm = voxel_mm;
  info.z_start_mm = -4;
  info.angle_step_deg = 360.0 / angles;
  return info;
}

std::vector<Image> light_of(int rows) {
  std::vector<Image> light;
  unsigned state = 1;
  for (int r = 0; r < rows; ++r) {
    light.emplace_back(columns, angles);
    for (float& value : light.back().values) value = static_cast<float>((state = state * 1664525 + 1013904223) >> 8);
  }
  return light;
}

model::Grid grid() { return model::centred_grid(30, 30, slices, voxel_mm, -4); }

/// As it comes out of the stream, the rows pushed in pieces of that many.
std::vector<Image> streamed(const Simulation& simulation, const std::vector<Image>& light, std::size_t piece,
                            const std::vector<Image>& inserts = {}) {
  std::vector<Image> doses;
  DoseStream stream(simulation, inserts, [&](Image dose) { doses.push_back(std::move(dose)); });
  for (std::size_t r = 0; r < light.size(); r += piece) {
    const auto first = light.begin() + static_cast<std::ptrdiff_t>(r);
    stream.push({first, first + static_cast<std::ptrdiff_t>(std::min(piece, light.size() - r))});
  }
  stream.finish();
  return doses;
}

void check_same(const std::vector<Image>& streamed, const std::vector<Image>& whole) {
  REQUIRE(streamed.size() == whole.size());
  std::size_t differ = 0;
  double sum = 0;
  for (std::size_t k = 0; k < whole.size(); ++k) {
    if (streamed[k].values != whole[k].values) ++differ;
    for (const float v : whole[k].values) sum += static_cast<double>(v);
  }
  CHECK(sum > 0);
  CHECK(differ == 0);
}

std::vector<Image> whole(const Simulation& simulation, const std::vector<Image>& light,
                         const std::vector<Image>& inserts = {}) {
  std::vector<Image> doses(slices);
  simulation.dose(light, doses, inserts);
  return doses;
}

}  // namespace

TEST_CASE("a stream of rows gives the same bytes as all rows at once, for any pieces and any number of threads") {
  const Simulation simulation(printer(), {}, stack(slices), grid());
  REQUIRE(simulation.climbs());
  const std::vector<Image> light = light_of(slices);
  const std::vector<Image> expected = whole(simulation, light);
  for (const std::size_t piece : {1, 16, 50, 203}) check_same(streamed(simulation, light, piece), expected);
  set_threads(1);
  check_same(streamed(simulation, light, 16), expected);
  set_threads(0);
}

TEST_CASE("the halo of a block is the rows that light it: fewer than all, and none too few") {
  const Simulation simulation(printer(), {}, stack(slices), grid());
  const Operator& light = *simulation.state().clear;
  const SlabRange all{0, 13};
  for (std::size_t first = 0; first < all.end; first += 4) {
    const SlabRange block{first, std::min(all.end, first + 4)};
    const SlabRange rows = light.lit_by(block);
    CHECK(rows.end - rows.first < 10);
    CHECK(rows.end - rows.first >= 2);
    CHECK(rows.end <= all.end);
  }
}

TEST_CASE("more rows than slices, and fewer") {
  for (const int rows : {120, 240}) {
    const Simulation simulation(printer(), {}, stack(rows), grid());
    const std::vector<Image> light = light_of(rows);
    check_same(streamed(simulation, light, 7), whole(simulation, light));
  }
}

TEST_CASE("slices that no row lights lie below those that rows light") {
  const model::Grid deep = model::centred_grid(30, 30, slices, voxel_mm, -34);
  const Simulation simulation(printer(), {}, stack(slices), deep);
  const SlabRange first = simulation.state().clear->lit_by({0, 4});
  REQUIRE(first.first >= first.end);
  const std::vector<Image> light = light_of(slices);
  for (const std::size_t piece : {1, 203}) check_same(streamed(simulation, light, piece), whole(simulation, light));
}

TEST_CASE("a stream around an insert, and of a part that is lifted past the image") {
  std::vector<Image> inserts(slices, Image(30, 30));
  for (int k = 40; k < 170; ++k) {
    for (int j = 12; j < 16; ++j) {
      for (int i = 10; i < 18; ++i) inserts[static_cast<std::size_t>(k)](i, j) = 1;
    }
  }
  const std::vector<Image> light = light_of(slices);
  const Simulation simulation(printer(), {}, stack(slices), grid());
  check_same(streamed(simulation, light, 16, inserts), whole(simulation, light, inserts));

  model::StackInfo helix = stack(slices);
  for (int k = 0; k < 2 * angles; ++k) helix.poses.push_back({15.0 * k, 0, 0, 0.3 * k - 7, model::Moves::vial});
  helix.height = 2 * angles;
  std::vector<Image> two_turns;
  for (const Image& row : light) {
    two_turns.emplace_back(columns, 2 * angles);
    std::copy(row.values.begin(), row.values.end(), two_turns.back().values.begin());
    std::copy(row.values.begin(), row.values.end(), two_turns.back().values.begin() + columns * angles);
  }
  const Simulation lifted(printer(), {}, helix, grid());
  check_same(streamed(lifted, two_turns, 16), whole(lifted, two_turns));
}

TEST_CASE("rows of another shape are refused") {
  const Simulation simulation(printer(), {}, stack(slices), grid());
  const std::vector<Image> light(16, Image(columns + 1, angles));
  DoseStream stream(simulation, {}, [](const Image&) {});
  CHECK_THROWS_AS(stream.push(light), Error);
}

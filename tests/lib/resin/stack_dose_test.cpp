// SPDX-License-Identifier: GPL-3.0-or-later
#include "resin/curethrough/stack_dose.hpp"

#include "lib/resin/corrected_column.hpp"
#include "resin/curethrough/cure_map.hpp"
#include "resin/curethrough/sweep.hpp"
#include "testing.hpp"

using namespace vam;

namespace {

constexpr int width = 7;
constexpr int height = 3;

std::vector<Image> random_stack(int slices, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<Image> stack(static_cast<std::size_t>(slices), Image(width, height));
  for (Image& slice : stack) {
    for (float& value : slice.values) value = uniform(random);
  }
  return stack;
}

std::vector<Image> doses(const std::vector<Image>& stack, const resin::CureLimits& limits) {
  resin::StackDose dose(limits, limits.phi_max);
  for (const Image& slice : stack) dose.add(slice);
  dose.turn();
  std::vector<Image> all(stack.size(), Image(width, height));
  const auto step = static_cast<std::size_t>(resin::StackDose::block_slices);
  for (std::size_t n = 0; n < stack.size(); n += step) {
    const std::size_t count = std::min(step, stack.size() - n);
    std::vector<float> below(count * width);
    for (int y = height - 1; y >= 0; --y) {
      dose.replay_row(static_cast<int>(n), {stack.data() + n, count}, y, below.data());
      for (std::size_t i = 0; i < count; ++i) std::copy_n(below.data() + i * width, width, all[n + i].row(y));
    }
  }
  return all;
}

}  // namespace

TEST_CASE("a stack read twice has the doses of its columns") {
  for (const int slices : {1, 31, 32, 33, 64, 150}) {
    const resin::CureLimits limits = resin::limits_of({});
    const auto stack = random_stack(slices, static_cast<unsigned>(slices));
    const auto below = doses(stack, limits);
    REQUIRE(below.size() == stack.size());
    for (std::size_t p = 0; p < width * height; ++p) {
      std::vector<double> phi;
      for (const Image& slice : stack) phi.push_back(limits.phi_max * static_cast<double>(slice.values[p]));
      const auto omega = resin::dose_at_nodes(phi, limits);
      for (std::size_t n = 0; n < stack.size(); ++n) {
        // Stored three times as float (block, sum over blocks, result), 6e-8 each.
        CHECK(std::fabs(below[n].values[p] - omega[n + 1]) <= 4e-7 * (1 + omega[n + 1]));
      }
    }
  }
}

TEST_CASE("slices of different sizes are refused") {
  resin::StackDose dose(resin::limits_of({}), 1);
  dose.add(Image(4, 4));
  CHECK_THROWS_WITH_AS(dose.add(Image(4, 5)), "slice 1: 4 x 5 pixels, the first has 4 x 4", Error);
}

TEST_CASE("height errors of the paper's ladder") {
  const resin::CureLimits limits = resin::limits_of({});
  std::vector<std::uint8_t> part(50, 0);
  for (std::size_t n = 0; n < 50; ++n) part[n] = (n / 10) % 2 == 1;
  const auto plain = resin::judge_column(part, resin::plain_column(part, limits), limits);
  REQUIRE(plain.by_height[10].features == 2);
  CHECK(plain.all().features == 2);
  // Both gaps above the rungs (10 slices each) are solid. The bottom edge of the lower rung is undercured up to the
  // height u where phi_max and what the dark brought below it make 1: phi_max (1 - q^u) + dark q^u = 1. The upper
  // rung's bottom edge is cured by the lower rung's light.
  const double dark = limits.phi_min * (1 - std::pow(limits.q, 10));
  const double u = std::log((limits.phi_max - 1) / (limits.phi_max - dark)) / std::log(limits.q);
  CHECK(plain.all().through == doctest::Approx(20).epsilon(1e-6));
  CHECK(plain.all().under == doctest::Approx(u).epsilon(1e-5));
  CHECK(plain.under == 3);  // voxel centres 0.5, 1.5 and 2.5 slices above the edge; u = 2.7

  const auto column = test::correct_column(part, limits, {1}, 0);
  const auto corrected = resin::judge_column(part, column.phi, limits);
  CHECK(corrected.correct == 20);
  CHECK(corrected.through == 0);
  CHECK(corrected.under == 0);
  // What tolerance 1e-6 of dose is in height at the edge: 1e-6 / (1 - q) slices an edge.
  CHECK(corrected.all().worst < 1e-4);
}

TEST_CASE("height errors are attributed to the feature whose light cures the gap") {
  // Layered, opaque resin: what is exposed is cured and nothing else.
  resin::Process process{
      .exposure = resin::ExposureMode::layered, .slice_um = 1000, .absorbance_height_um = 100, .speed_mm_h = 10};
  const resin::CureLimits limits = resin::limits_of(process);
  const double on = 2 / limits.q;
  const std::vector<std::uint8_t> part{0, 0, 0, 1, 1, 0, 0, 1, 0, 0};
  //                                   cured: slice 1 above the first, slice 4 missing, slice 6 above the second, 8
  //                                   below it
  const std::vector<double> phi{0, on, 0, on, 0, 0, on, on, on, 0};
  const auto totals = resin::judge_column(part, phi, limits);
  REQUIRE(totals.by_height[2].features == 1);
  REQUIRE(totals.by_height[1].features == 1);
  CHECK(totals.correct == 2);
  CHECK(totals.through == 3);
  CHECK(totals.under == 1);
  // A tenth of a layer's thickness receives ten times more; layers reach at most log10(2 / q) = 10.3 heights of 0.1 mm
  // up, so 0.03 of the layer above is cured.
  CHECK(totals.by_height[2].under == doctest::Approx(1).epsilon(0.04));
  CHECK(totals.by_height[2].through == doctest::Approx(1).epsilon(0.1));
  CHECK(totals.by_height[1].under == 0);
  CHECK(totals.by_height[1].through == doctest::Approx(2).epsilon(0.05));
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Whether there is anything to print.
#include "optimize/run/printable.hpp"

#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;

namespace {

constexpr int size = 9;

/// Two slices with one voxel of that coverage in the second.
VolumeTask one_voxel(float coverage, int x = 4) {
  VolumeTask task;
  task.circle = {4, 4, 4};
  task.source.slices = 2;
  task.source.target = [=](int k, int count, float* out) {
    std::fill_n(out, count * size * size, 0.0F);
    for (int n = 0; n < count; ++n) {
      if (k + n == 1) out[n * size * size + 4 * size + x] = coverage;
    }
  };
  return task;
}

void require(const VolumeTask& task) { require_printable(task, {size, size}, "part.vdb"); }

}  // namespace

TEST_CASE("a part without a voxel that is covered by half is refused") {
  CHECK_THROWS_WITH_AS(require(one_voxel(0.45F)),
                       doctest::Contains("part.vdb: no voxel is at least half covered (maximum 0.45)"), Error);
  CHECK_NOTHROW(require(one_voxel(0.5F)));
  CHECK_NOTHROW(require(one_voxel(1)));
  CHECK_NOTHROW(require(one_voxel(0)));  // empty: for check() to say
  CHECK_THROWS_AS(require(one_voxel(0.3F, 7)), Error);
  VolumeTask grey = one_voxel(0.1F);
  grey.demands.grey = true;
  CHECK_NOTHROW(require(grey));
}

TEST_CASE("unconstrained or unexposed parts are refused") {
  VolumeOutcome outcome{.dark_part_voxels = 12};
  CHECK_THROWS_WITH_AS(require_light(outcome, "part.vdb"),
                       doctest::Contains("part.vdb: no part voxel is constrained (12 are"), Error);
  outcome.metrics.part = 100;
  CHECK_THROWS_WITH_AS(require_light(outcome, "part.vdb"), doctest::Contains("no light reaches the part"), Error);
  CHECK_THROWS_WITH_AS(require_light(outcome, "part.vdb", 1.25),
                       doctest::Contains("more than 1.25 voxels from its surface"), Error);
  outcome.metrics.max_part = 0.9;
  CHECK_NOTHROW(require_light(outcome, "part.vdb"));
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Runs that must end in time, by a clock that advances as it is asked.
#include "lib/optimize/volumes.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace volumes;

namespace {

/// An iteration takes a second by this clock, which is read once an iteration and once a pass.
struct Clock {
  double now_s = 0;
  [[nodiscard]] Deadline deadline(double end_s, double rest) {
    return {[this] { return now_s++; }, end_s, rest};
  }
};

VolumeTask endless_task() {
  VolumeTask task;
  task.make = [](double) { return make_method("apg", {}); };
  task.limits.iterations = 1000;
  task.limits.patience = 0;
  return task;
}

}  // namespace

TEST_CASE("no iteration begins that, with the rest, would end after the deadline") {
  const std::vector<std::vector<float>> slices{vam::oracle::disc_grid(size, 0.5)};
  for (const double rest : {0.0, 3.0, 10.0}) {
    Clock clock;
    VolumeTask task = endless_task();
    task.limits.deadline = clock.deadline(40, rest);
    const VolumeOutcome outcome = run(slices, task).outcome;
    CHECK(outcome.stop == StopReason::time);
    CHECK(outcome.iterations > 30 - rest);
    CHECK(clock.now_s + rest <= 42);
  }
}

TEST_CASE("a deadline that has passed leaves the start") {
  const std::vector<std::vector<float>> slices{vam::oracle::disc_grid(size, 0.5)};
  Clock clock;
  VolumeTask task = endless_task();
  task.limits.deadline = clock.deadline(0, 3);
  const Written written = run(slices, task);
  CHECK(written.outcome.iterations == 0);
  CHECK(written.outcome.metrics.max_part > 0);
}

TEST_CASE("every pass has its share of the time") {
  std::vector<std::vector<float>> slices;
  for (int k = 0; k < 130; ++k) slices.push_back(vam::oracle::gyroid(size, 3, 0.05 * k, 0.4));
  Clock clock;
  VolumeTask task = endless_task();
  task.limits.deadline = clock.deadline(60, 0);
  const VolumeOutcome outcome = run(slices, task).outcome;
  CHECK(outcome.stop == StopReason::time);
  CHECK(outcome.iterations < 45);  // three passes, the last of 2 slices
  CHECK(clock.now_s <= 65);
}

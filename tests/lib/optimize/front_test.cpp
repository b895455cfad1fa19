// SPDX-License-Identifier: GPL-3.0-or-later
// The front of duration against window.
#include "optimize/run/front.hpp"

#include "lib/optimize/volumes.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace volumes;

namespace {

VolumeTask front_task() {
  VolumeTask task;
  task.limit.of_even = shortest_of_even;
  task.raising = front_raising;
  task.limits = {.iterations = front_iterations, .until = {}, .patience = 0};
  task.make = [](double limit) { return make_method("apg", MethodOptions{.max_intensity = limit}); };
  task.front = [](std::vector<Image> frames) { return frames; };
  return task;
}

}  // namespace

TEST_CASE("a front has eight limits, each higher, and its last print is the run's") {
  const auto result = run({vam::oracle::resolution_target(size)}, front_task());
  const auto& front = result.outcome.front;
  REQUIRE(front.size() == front_points);
  for (std::size_t i = 0; i < front.size(); ++i) {
    CHECK(front[i].peak <= 1.00001 * front[i].max_intensity);
    if (i > 0) CHECK(front[i].max_intensity == doctest::Approx(1.3 * front[i - 1].max_intensity));
  }
  CHECK(front.back().metrics.pw > front.front().metrics.pw);
  CHECK(front.back().metrics.pw == doctest::Approx(result.outcome.metrics.pw).epsilon(1e-4));
  CHECK(front.back().peak == doctest::Approx(result.outcome.peak_intensity).epsilon(1e-5));
}

TEST_CASE("a front is judged as it is shown") {
  VolumeTask task = front_task();
  task.front = [](std::vector<Image> frames) {
    for (Image& frame : frames) std::fill(frame.values.begin(), frame.values.end(), 0.25F);
    return frames;
  };
  const auto result = run({vam::oracle::wheel(size)}, task);
  for (const FrontPoint& point : result.outcome.front) {
    CHECK(point.peak == 0.25);
    CHECK(point.metrics.pw < 0);  // even light has no window
  }
}

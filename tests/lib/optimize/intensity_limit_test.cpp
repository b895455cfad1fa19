// SPDX-License-Identifier: GPL-3.0-or-later
// Bounds on the projected intensity: held in every method, and never worse than clipping.
#include <cstring>

#include "base/text/json.hpp"
#include "lib/optimize/parts.hpp"
#include "lib/optimize/volumes.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/run/slice_figures.hpp"
#include "optimize/target/schedule.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;
using namespace volumes;

namespace {

std::vector<std::string> limited_methods() {
  return method_names([](const MethodEntry& method) {
    return std::find(method.options.begin(), method.options.end(), "--max-intensity") != method.options.end();
  });
}

}  // namespace

TEST_CASE("intensity never exceeds its bound, whatever the final scale") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size), vam::oracle::resolution_target(size)};
  for (const std::string& name : limited_methods()) {
    CAPTURE(name);
    VolumeTask task;
    MethodOptions options;
    options.max_intensity = task.limit.most = 2;
    task.limits = {.iterations = 12, .until = {}, .patience = 0};
    task.make = [&](double) { return make_method(name, options); };
    const auto result = run(slices, task);
    float most = 0;
    for (const auto& image : result.images) {
      most = std::max(most, *std::max_element(image.values.begin(), image.values.end()));
    }
    CHECK(most <= 2.00001F);
    CHECK(most > 1.0F);
  }
}

TEST_CASE("limited intensity prints no worse than the unlimited answer, clipped") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size), vam::oracle::resolution_target(size)};
  const auto made = [&](const std::string& name, double limit) {
    VolumeTask task;
    MethodOptions options;
    options.max_intensity = task.limit.most = limit;
    task.limits = {.iterations = 30, .until = {}, .patience = 0};
    task.make = [name, options](double) { return make_method(name, options); };
    return run(slices, task);
  };
  for (const std::string& name : limited_methods()) {
    CAPTURE(name);
    const auto unlimited = made(name, 0);
    for (const double limit : {4.0, 2.0, 1.0, 0.5, 0.35}) {
      CAPTURE(limit);
      auto clipped = unlimited.images;
      for (auto& image : clipped) {
        for (float& v : image.values) v = std::min(v, static_cast<float>(limit));
      }
      const auto limited = made(name, limit);
      for (const auto& image : limited.images) {
        CHECK(std::all_of(image.values.begin(), image.values.end(), [](float v) { return std::isfinite(v); }));
      }
      CHECK(quality(slices, limited.images) >= quality(slices, clipped) - 0.005);
    }
  }
}

TEST_CASE("an intensity limit that cannot print is refused with the least that can") {
  VolumeTask task;
  task.limit.most = 0.01;
  CHECK_THROWS_WITH_AS(run({vam::oracle::wheel(size)}, task),
                       doctest::Contains("if every pixel is lit at every angle, and the threshold is 0.8"), Error);
}

TEST_CASE("a grey target may need less intensity than a print") {
  VolumeTask task;
  task.demands.grey = true;
  task.limit.most = 0.01;
  task.limits.iterations = 1;
  task.make = [](double) { return make_method("apg", {}); };
  std::vector<float> faint = vam::oracle::wheel(size);
  for (float& v : faint) v *= 0.02F;
  CHECK_NOTHROW(run({faint}, task));
}

TEST_CASE("the even intensity gives the threshold dose on average") {
  VolumeTask task;
  task.limit.of_even = 2;
  const auto result = run({vam::oracle::wheel(size)}, task);
  // Parallel light from all sides: a dose of 2 pi times the intensity.
  CHECK(result.outcome.even_intensity == doctest::Approx(0.8 / (2 * std::numbers::pi)).epsilon(0.01));
  CHECK(result.outcome.max_intensity == doctest::Approx(2 * result.outcome.even_intensity));
}

TEST_CASE("a limit too low for the goal is raised until the goal is met, and no further") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size), vam::oracle::resolution_target(size)};
  const auto made = [&](double of_even, Raising raising, int iterations) {
    VolumeTask task;
    task.limit.of_even = of_even;
    task.raising = raising;
    task.limits = {.iterations = iterations, .until = model::parse_conditions("ver=0", SliceFigures::names())};
    task.limits.patience = 0;
    task.make = [](double limit) { return make_method("apg", MethodOptions{.max_intensity = limit}); };
    return run(slices, task).outcome;
  };
  constexpr double start = 1.1;
  constexpr double factor = 1.3;
  CHECK(made(start, {}, 60).stop == StopReason::iterations);
  const VolumeOutcome raised = made(start, {.factor = factor, .first = 12, .next = 6}, 200);
  CHECK(raised.stop == StopReason::goal);
  CHECK(raised.metrics.ver == 0);
  CHECK(raised.max_intensity > 1.01 * start * raised.even_intensity);
  CHECK(raised.peak_intensity <= 1.00001 * raised.max_intensity);
  CHECK(raised.peak_intensity > raised.max_intensity / factor);  // the last raise was needed
  const VolumeOutcome cut = made(start, {.factor = factor, .first = 12, .next = 6}, 13);
  CHECK(cut.iterations == 13);
  CHECK(cut.stop == StopReason::iterations);
}

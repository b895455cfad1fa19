// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/volume.hpp"

#include <cstring>

#include "base/text/json.hpp"
#include "lib/optimize/parts.hpp"
#include "lib/optimize/volumes.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/target/schedule.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;
using namespace volumes;

TEST_CASE("a constant cross-section costs one slice, and equal slices get equal projections") {
  const auto wheel = vam::oracle::wheel(size);
  const std::vector<float> empty(size * size, 0.0F);
  std::vector<std::vector<float>> slices(100, wheel);
  slices.front() = slices.back() = empty;
  const auto result = run(slices);
  CHECK(result.outcome.jobs == 2);
  REQUIRE(result.images.size() == 100);
  CHECK(result.images[1].values == result.images[98].values);
  CHECK(*std::max_element(result.images[0].values.begin(), result.images[0].values.end()) == 0.0F);
}

TEST_CASE("one threshold dose prints all slices: the middle of the window, in every slice") {
  const auto disc = [](double radius) {
    return vam::oracle::draw(size, [=](double x, double y) { return std::hypot(x - 4, y) < radius; });
  };
  const std::vector<std::vector<float>> slices{disc(4), disc(12), disc(24), vam::oracle::wheel(size)};
  VolumeTask task;
  task.demands.free_surface = true;                           // fbp does not ask for it
  task.make = [](double) { return make_method("fbp", {}); };  // clipping alone gives each of them another scale
  const auto result = run(slices, task);
  for (std::size_t s = 0; s < slices.size(); ++s) {
    CAPTURE(s);
    const auto dose = dose_of(result.images[s]);
    vam::model::DoseStatistics statistics;
    for (std::size_t i = 0; i < dose.size(); ++i) {
      if (parts::circle(size).contains(static_cast<int>(i) % size, static_cast<int>(i) / size))
        statistics.add(dose[i], vam::model::label_of(slices[s][i]));
    }
    const auto m = statistics.metrics();
    CHECK(m.min_part > task.demands.window.threshold() * 0.9);
    const bool middle = std::abs(m.iou_threshold - task.demands.window.threshold()) < 1e-3;
    const bool wide =
        std::abs(m.min_part - task.demands.window.high) < 1e-3 && m.max_void < task.demands.window.threshold();
    CHECK((middle || wide));
  }
}

TEST_CASE("more slices than a pass come out in order, each as if alone") {
  std::vector<std::vector<float>> slices;
  for (int k = 0; k < 70; ++k) {  // discs and diamonds, whose edges cross those of their neighbours
    slices.push_back(vam::oracle::draw(size, [=](double x, double y) {
      const double from_middle = k % 2 == 0 ? std::hypot(x, y - 8) : 0.8 * (std::abs(x) + std::abs(y - 8));
      return from_middle < 5 + 0.2 * k;
    }));
  }
  for (const std::string name : {"dose-norm", "apg"}) {
    CAPTURE(name);
    VolumeTask task;
    task.limits.iterations = name == "apg" ? 12 : 0;
    task.limits.patience = 0;  // counts iterations of a whole pass
    task.make = [&](double most) { return make_method(name, {.max_intensity = most}); };
    const auto all = run(slices, task);
    CHECK(all.outcome.jobs == 70);
    for (const int k : {66, 33}) {
      CAPTURE(k);
      const auto alone = run({slices[k]}, task);
      // The filter transforms two slices at a time, so a neighbour changes the rounding: a few ulp of the largest
      // value.
      const auto& want = alone.images[0].values;
      const float largest = *std::max_element(want.begin(), want.end());
      float worst = 0;
      for (std::size_t i = 0; i < want.size(); ++i)
        worst = std::max(worst, std::abs(all.images[k].values[i] - want[i]));
      CHECK(worst < 1e-5F * largest);
    }
  }
}

// Nine walls of seven slices, each a disc of its own size, with void between them; the sixth wall has a slit.
TEST_CASE("pieces and torn voxels are those of the volume, whatever the passes, jobs and halos are") {
  std::vector<std::vector<float>> slices;
  for (int k = 0; k < 90; ++k) {
    const double radius = k % 10 < 2 || k % 10 > 8 ? 0 : 6 + k / 10;
    slices.push_back(vam::oracle::draw(
        size, [=](double x, double y) { return std::hypot(x, y - 8) < radius && (k / 10 != 5 || std::abs(x) > 2); }));
  }
  for (const double blur_px : {0.0, 0.3}) {
    CAPTURE(blur_px);
    VolumeTask task;
    task.blur_px = blur_px;
    task.limits.iterations = 12;
    task.make = [](double most) { return make_method("apg", {.max_intensity = most}); };
    const auto result = run(slices, task);
    vam::verdict::PrintPieceCounter counter(size, size, task.demands.window.threshold());
    for (std::size_t k = 0; k < slices.size(); ++k) counter.add(dose_of(result.images[k]).data(), slices[k].data(), 1);
    REQUIRE(result.print.pieces);
    const vam::verdict::PrintPieces& found = *result.print.pieces;
    CHECK(found.part == 10);
    CHECK(found.part_at_half == 10);
    CHECK(found.print == 10);
    CHECK(found.print == counter.found().print);
    if (blur_px > 0) continue;
    CHECK(found.broken == counter.found().broken);
    CHECK(found.shut == counter.found().shut);
    CHECK(found.holes == counter.found().holes);
  }
}

TEST_CASE("a slice barely touched by the part is printed from half coverage on") {
  auto cut = [](float coverage) {
    auto slice = vam::oracle::wheel(size);
    for (float& v : slice) v *= coverage;
    return slice;
  };
  const auto result = run({vam::oracle::wheel(size), cut(0.6F), cut(0.4F)});
  const auto largest = [&](std::size_t s) {
    return *std::max_element(result.images[s].values.begin(), result.images[s].values.end());
  };
  CHECK(largest(1) == doctest::Approx(largest(0)).epsilon(0.1));
  CHECK(largest(2) == 0.0F);
}

TEST_CASE("a part beyond the writable radius is refused with both radii") {
  VolumeTask task;
  task.circle = {31.5, 31.5, 20};
  CHECK_THROWS_WITH_AS(run({vam::oracle::wheel(size)}, task), doctest::Contains("light reaches only 20;"), vam::Error);
}

TEST_CASE("targets without part or without void are refused") {
  CHECK_THROWS_WITH_AS(run({std::vector<float>(size * size, 0.0F)}), doctest::Contains("is empty"), vam::Error);
  VolumeTask task;
  task.circle = {31.5, 31.5, 20};
  const auto full = vam::oracle::draw(size, [](double x, double y) { return std::hypot(x, y) < 19.9; });
  auto disc = full;
  for (float& v : disc) v = v > 0 ? 1.0F : 0.0F;
  task.circle.radius = 19;  // smaller than the disc, larger than nothing: the part leaves it, which is said first
  CHECK_THROWS_WITH_AS(run({disc}, task), doctest::Contains("light reaches only 19;"), vam::Error);
  std::vector<float> filled(size * size, 0.0F);
  task.circle.radius = 20;
  for (int i = 0; i < size * size; ++i) {
    if (task.circle.contains(i % size, i / size)) filled[i] = 1.0F;
  }
  CHECK_THROWS_WITH_AS(run({filled}, task), doctest::Contains("fills the whole"), vam::Error);
}

TEST_CASE("an insert that overlaps the part is refused; one that shadows it is reported") {
  const auto disc = vam::oracle::draw(size, [](double x, double y) { return std::hypot(x, y) < 10; });
  const auto ring = vam::oracle::draw(size, [](double x, double y) { return std::abs(std::hypot(x, y) - 14) < 2; });
  const auto outside = vam::oracle::draw(size, [](double x, double y) {
    return std::hypot(x, y) < 10 || (std::hypot(x, y) > 19 && std::hypot(x, y) < 24);
  });
  VolumeTask task;
  task.source.insert = [&](int, int count, float* out) {
    for (int i = 0; i < count; ++i) out = std::copy(disc.begin(), disc.end(), out);
  };
  CHECK_THROWS_WITH_AS(run({disc}, task), doctest::Contains("part and insert share"), vam::Error);
  task.source.insert = [&](int, int count, float* out) {
    for (int i = 0; i < count; ++i) out = std::copy(ring.begin(), ring.end(), out);
  };
  task.around = [](std::span<const Slab> inserts) { return parts::parallel_light(size, angles, inserts); };
  const auto result = run({outside}, task);
  CHECK(result.outcome.dark_part_voxels > 250);  // the disc of 314 pixels inside the ring, its rim being surface
  CHECK(result.outcome.dark_part_voxels < 314);
}

TEST_CASE("an insert may fill a whole slice") {
  const auto wheel = vam::oracle::wheel(size);
  const std::vector<float> nothing(wheel.size(), 0.0F);
  const std::vector<float> everything(wheel.size(), 1.0F);
  VolumeTask task;
  task.limits.iterations = 3;
  task.make = [](double) { return make_method("apg", {}); };
  task.source.insert = [&](int k, int count, float* out) {
    for (int i = 0; i < count; ++i) {
      const auto& from = k + i == 0 ? everything : nothing;
      out = std::copy(from.begin(), from.end(), out);
    }
  };
  task.around = [](std::span<const Slab> inserts) { return parts::parallel_light(size, angles, inserts); };
  const auto result = run({nothing, wheel}, task);
  CHECK(result.outcome.metrics.iou > 0.9);
}

TEST_CASE("the loop stops at its goal, and when it stagnates") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size)};
  VolumeTask task;
  task.watch = true;
  task.make = [](double) { return make_method("cal", {}); };
  task.limits.iterations = 500;
  task.limits.until = vam::model::parse_conditions("iou>=0.9", {"ver", "pw", "ipdr", "cv", "iou"});
  const auto goal = run(slices, task);
  CHECK(goal.outcome.stop == StopReason::goal);
  CHECK(goal.outcome.trace.back().iou >= 0.9);
  CHECK(static_cast<int>(goal.outcome.trace.size()) == goal.outcome.iterations + 1);
  task.limits.least_rate = 0.6;  // and on while a fifth of the cost widens the latitude by so much
  const auto knee = run(slices, task);
  const auto& trace = knee.outcome.trace;
  CHECK(knee.outcome.stop == StopReason::goal);
  CHECK(knee.outcome.iterations > goal.outcome.iterations);
  CHECK(knee.outcome.growth < 0.6);
  const int before = static_cast<int>(0.8 * (knee.outcome.iterations + 10) - 10);
  CHECK(trace.back().latitude < 1.15 * trace[before].latitude);
  task.limits.least_rate = 0;
  task.limits.until.clear();
  const auto stalled = run(slices, task);
  CHECK(stalled.outcome.stop == StopReason::no_progress);
  CHECK(stalled.outcome.iterations < 500);
  task.limits.at_least = stalled.outcome.iterations + 5;  // before which patience does not end
  CHECK(run(slices, task).outcome.iterations >= task.limits.at_least);
}

TEST_CASE("a run that may leave the print open ends at twice the iterations that count") {
  const auto wheel = vam::oracle::wheel(size);
  const auto light = parts::parallel_light(size, angles);
  const Problem problem = parts::make_problem(wheel.data(), 1, size, size, parts::circle(size), {});
  int asked = 0;
  Limits limits{.iterations = 30, .at_least = 5, .patience = 0};
  limits.until = vam::model::parse_conditions("iou>=0", SliceFigures::names());
  limits.prints = [&](const Iterate&) { return ++asked < 0; };
  for (const bool leaves_open : {true, false}) {
    limits.leaves_open = leaves_open;
    Iterate state;
    const Outcome outcome = run_method(*make_method("apg", {}), problem, *light, limits, state);
    CHECK(outcome.stop == (leaves_open ? StopReason::no_progress : StopReason::iterations));
    CHECK(outcome.iterations == (leaves_open ? 10 : 30));
    CHECK(asked == outcome.iterations - 4);
    asked = 0;
  }
}

TEST_CASE("without a goal the best iterate is the result, whatever comes after it") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size)};
  int later = 0;  // iterations after the best one
  for (const std::string name : {"cal", "osmo", "pm", "bclp"}) {
    CAPTURE(name);
    VolumeTask task;
    task.watch = true;
    task.make = [&](double) { return make_method(name, {}); };
    task.limits = {.iterations = 25, .until = {}, .patience = 25, .least_gain = 0};
    const auto best = run(slices, task);
    const auto& trace = best.outcome.trace;
    const auto at =
        std::max_element(trace.begin(), trace.end(), [](const auto& a, const auto& b) { return merit(a) < merit(b); });
    CHECK(merit(best.outcome.metrics) == doctest::Approx(merit(*at)).epsilon(2e-4));
    later += static_cast<int>(trace.end() - at) - 1;
    // The same as ending there.
    task.limits = {.iterations = static_cast<int>(at - trace.begin()), .until = {}, .patience = 0};
    CHECK(run(slices, task).images[0].values == best.images[0].values);
  }
  CHECK(later > 0);
}

TEST_CASE("initial projections are used") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size)};
  VolumeTask task;
  task.limits.iterations = 20;
  task.make = [](double) { return make_method("cal", {}); };
  const auto first = run(slices, task);
  task.limits.iterations = 0;
  task.initial = [&](int k) { return first.images[k]; };
  const auto again = run(slices, task);
  CHECK(again.outcome.metrics.pw == doctest::Approx(first.outcome.metrics.pw).epsilon(1e-4));
}

TEST_CASE("the schedule drops results that would be held too long") {
  std::vector<SliceDigest> slices;
  for (std::uint64_t i : {1U, 1U, 2U, 3U, 4U, 1U, 4U}) slices.push_back({i, i});
  const auto generous = make_schedule(slices, 10);
  CHECK(generous.job_of_slice == std::vector<int>{0, 0, 1, 2, 3, 0, 3});
  CHECK(generous.last_slice == std::vector<int>{5, 2, 3, 6});
  const auto tight = make_schedule(slices, 1);
  CHECK(tight.job_of_slice == std::vector<int>{0, 0, 1, 2, 3, 4, 3});
}

TEST_CASE("digests differ for one bit and for another order") {
  const std::vector<float> a{1, 2, 3};
  const std::vector<float> b{1, 2, 3.0000002F};
  const std::vector<float> c{2, 1, 3};
  CHECK(digest(a) == digest(std::vector<float>{1, 2, 3}));
  CHECK(digest(a) != digest(b));
  CHECK(digest(a) != digest(c));
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/checkpoint_state.hpp"

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

namespace {

/// Runs a task that is interrupted after every `steps` iterates until it is complete.
struct Broken {
  Written result;
  int times = 0;
  std::string state;  // the last one
};

Broken run_in_pieces(const std::vector<std::vector<float>>& slices, const VolumeTask& task, int steps) {
  Broken broken;
  for (;;) {
    std::string next;
    std::size_t read = 0;
    Archive to(Archive::Direction::out, "state",
               [&](void* bytes, std::size_t n) { next.append(static_cast<const char*>(bytes), n); });
    Archive from(Archive::Direction::in, "state", [&](void* bytes, std::size_t n) {
      REQUIRE(read + n <= broken.state.size());
      std::copy_n(broken.state.data() + read, n, static_cast<char*>(bytes));
      read += n;
    });
    int left = steps;
    VolumeTask piece = task;
    piece.checkpoint = {[&] { return left-- == 0; }, &to, broken.times > 0 ? &from : nullptr, "job"};
    broken.result = run(slices, piece);
    if (broken.result.outcome.stop != StopReason::interrupted) return broken;
    broken.state = next;
    ++broken.times;
    REQUIRE(broken.times < 100);
  }
}

}  // namespace

TEST_CASE("a run interrupted repeatedly gives the bytes of an uninterrupted one, with every method") {
  std::vector<std::vector<float>> slices;
  for (int k = 0; k < 70; ++k) {  // two passes; the last slices come again
    slices.push_back(
        vam::oracle::draw(size, [=](double x, double y) { return std::hypot(x, y - 8) < 5 + 0.2 * (k % 67); }));
  }
  for (const auto& name : method_names()) {
    CAPTURE(name);
    VolumeTask task;
    task.watch = true;
    task.limits = {.iterations = 7, .until = {}, .patience = 3};
    task.make = [&](double) { return make_method(name, {}); };
    const auto whole = run(slices, task);
    const auto broken = run_in_pieces(slices, task, 2);
    if (name != "fbp") CHECK(broken.times >= 2);
    REQUIRE(broken.result.images.size() == slices.size());
    bool same = true;
    for (std::size_t k = 0; k < slices.size(); ++k) {
      same = same && broken.result.images[k].values == whole.images[k].values;
    }
    CHECK(same);
    CHECK(report(broken.result.outcome).dump() == report(whole.outcome).dump());
    CHECK(trace_csv(broken.result.outcome.trace) == trace_csv(whole.outcome.trace));
  }
}

TEST_CASE("slices that are asked for have the projections of the whole, interrupted or not") {
  std::vector<std::vector<float>> slices;
  for (int k = 0; k < 70; ++k) {  // two passes; the last slices come again
    slices.push_back(
        vam::oracle::draw(size, [=](double x, double y) { return std::hypot(x, y - 8) < 5 + 0.2 * (k % 67); }));
  }
  VolumeTask task;
  task.watch = true;
  task.limits = {.iterations = 12, .until = {{"pw", ">=", 0.9}}, .patience = 0};
  task.limit = {.most = 0, .of_even = 1.5};
  task.raising = {.factor = 1.5, .first = 4, .next = 4};  // the first pass raises the limit of the second
  task.make = [&](double most) { return make_method("apg", {.max_intensity = most}); };
  const auto whole = run(slices, task);
  for (const model::ImageRange asked : {model::ImageRange{0, 3}, {60, 66}, {65, 70}}) {
    CAPTURE(asked.from);
    task.slices = asked;
    const auto some = run(slices, task);
    REQUIRE(count_of(some.images) == asked.count());
    bool same = true;
    for (int k = asked.from; k < asked.to; ++k) {
      same = same && some.images[k - asked.from].values == whole.images[k].values;
    }
    CHECK(same);
    CHECK(some.outcome.metrics.part > 0);
    CHECK(some.outcome.metrics.part < whole.outcome.metrics.part);
    const auto broken = run_in_pieces(slices, task, 3);
    CHECK(broken.times >= 2);
    CHECK(broken.result.images.back().values == some.images.back().values);
    CHECK(report(broken.result.outcome).dump() == report(some.outcome).dump());
    CHECK(trace_csv(broken.result.outcome.trace) == trace_csv(some.outcome.trace));
  }
}

TEST_CASE("the same where a run ends without progress, at its best iterate or its last") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size)};
  for (const std::string name : {"apg", "cal", "osmo"}) {
    for (const bool surface : {true, false}) {
      CAPTURE(name);
      CAPTURE(surface);
      VolumeTask task;
      task.demands.free_surface = !surface;
      task.limits = {.iterations = 40, .until = {}, .patience = 6};
      task.limit.of_even = 1.5;
      task.raising = {.factor = 1.3, .first = 12, .next = 8};
      task.make = [&](double most) { return make_method(name, MethodOptions{.max_intensity = most}); };
      const auto whole = run(slices, task);
      const auto broken = run_in_pieces(slices, task, 2);
      CHECK(broken.times >= 2);
      CHECK(broken.result.images[0].values == whole.images[0].values);
      CHECK(report(broken.result.outcome).dump() == report(whole.outcome).dump());
    }
  }
}

TEST_CASE("the same where a blur joins the slices, and the passes overlap") {
  std::vector<std::vector<float>> slices;
  for (int k = 0; k < 70; ++k) {
    slices.push_back(vam::oracle::draw(size, [=](double x, double y) { return std::hypot(x, y - 8) < 5 + 0.2 * k; }));
  }
  VolumeTask task;
  task.blur_px = 0.8;
  task.limits = {.iterations = 4, .until = {}, .patience = 0};
  task.make = [](double) { return make_method("apg", {}); };
  const auto whole = run(slices, task);
  const auto broken = run_in_pieces(slices, task, 3);
  REQUIRE(whole.images.size() == 70);
  CHECK(whole.outcome.jobs == 70);
  CHECK(broken.times == 2);
  bool same = true;
  for (std::size_t k = 0; k < 70; ++k) same = same && broken.result.images[k].values == whole.images[k].values;
  CHECK(same);
  task.make = [](double) { return make_method("osmo", {}); };
  CHECK_THROWS_WITH_AS(run(slices, task), doctest::Contains("neglect the blur"), vam::Error);
}

TEST_CASE("a part that continues beyond a pass has no surface where the pass ends") {
  const std::vector<std::vector<float>> slices(
      96, vam::oracle::draw(size, [](double x, double y) { return std::hypot(x, y - 8) < 6; }));
  VolumeTask task;
  task.blur_px = 4;  // passes of 48 and 64 slices, with 12 on either side that others keep
  task.limits = {.iterations = 3, .until = {}, .patience = 0};
  task.make = [](double) { return make_method("apg", {}); };
  const auto whole = run(slices, task);
  REQUIRE(whole.images.size() == 96);
  const auto& below = whole.images[39].values;  // the last of the first pass, far from the part's ends
  const auto& above = whole.images[40].values;
  const float most = *std::max_element(below.begin(), below.end());
  float step = 0;
  for (std::size_t i = 0; i < below.size(); ++i) step = std::max(step, std::abs(above[i] - below[i]));
  CHECK(most > 0);
  CHECK(step < 0.05F * most);
}

TEST_CASE("a blur wider than passes overlap: a part that is its own mirror image gets mirrored projections") {
  constexpr int count = 90;
  std::vector<std::vector<float>> slices;
  for (int k = 0; k < count; ++k) {
    const double radius = 4 + 0.1 * std::min(k, count - 1 - k);
    slices.push_back(vam::oracle::draw(size, [=](double x, double y) { return std::hypot(x, y - 8) < radius; }));
  }
  VolumeTask task;
  task.blur_px = 9;
  task.limits = {.iterations = 3, .until = {}, .patience = 0};
  task.make = [](double) { return make_method("apg", {}); };
  const auto whole = run(slices, task);
  REQUIRE(whole.images.size() == count);
  float most = 0;
  float apart = 0;
  for (int k = 0; k < count; ++k) {
    const auto& one = whole.images[k].values;
    const auto& other = whole.images[count - 1 - k].values;
    for (std::size_t i = 0; i < one.size(); ++i) {
      most = std::max(most, one[i]);
      apart = std::max(apart, std::abs(one[i] - other[i]));
    }
  }
  CHECK(apart < 1e-4 * most);  // sums of floats in another order
}

TEST_CASE("the same while the limit on intensity is raised") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size), vam::oracle::resolution_target(size)};
  VolumeTask task;
  task.limit.of_even = 1.1;
  task.raising = {.factor = 1.3, .first = 4, .next = 3};
  task.limits = {.iterations = 20, .until = {}, .patience = 0};
  task.make = [](double limit) { return make_method("apg", MethodOptions{.max_intensity = limit}); };
  const auto whole = run(slices, task);
  CHECK(whole.outcome.max_intensity > 2 * 1.1 * whole.outcome.even_intensity);
  for (const int steps : {1, 4, 5}) {
    const auto broken = run_in_pieces(slices, task, steps);
    CHECK(broken.times >= 3);
    for (std::size_t k = 0; k < slices.size(); ++k) {
      CHECK(broken.result.images[k].values == whole.images[k].values);
    }
    CHECK(report(broken.result.outcome).dump() == report(whole.outcome).dump());
  }
}

TEST_CASE("a damaged state, and one of another job, are refused") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size)};
  VolumeTask task;
  task.limits.iterations = 5;
  task.make = [](double) { return make_method("apg", {}); };
  std::string state;
  Archive to(Archive::Direction::out, "state",
             [&](void* bytes, std::size_t n) { state.append(static_cast<const char*>(bytes), n); });
  task.checkpoint = {[] { return true; }, &to, nullptr, "job"};
  REQUIRE(run(slices, task).outcome.stop == StopReason::interrupted);
  const auto resume = [&](const std::string& bytes, const std::string& job) {
    std::size_t read = 0;
    Archive from(Archive::Direction::in, "x.state", [&](void* to_, std::size_t n) {
      if (read + n > bytes.size()) throw vam::Error{vam::Fault::data, "x.state: ends early"};
      std::copy_n(bytes.data() + read, n, static_cast<char*>(to_));
      read += n;
    });
    VolumeTask again = task;
    again.checkpoint = {{}, nullptr, &from, job};
    return run(slices, again);
  };
  CHECK(resume(state, "job").outcome.stop != StopReason::interrupted);
  CHECK_THROWS_WITH_AS(resume(state, "other"), doctest::Contains("x.state: is a checkpoint of another job"),
                       vam::Error);
  std::string bad = state;
  const float nan = std::nanf("");
  std::memcpy(bad.data() + bad.size() / 2 / 4 * 4, &nan, sizeof nan);  // in the middle of the doses
  CHECK_THROWS_WITH_AS(resume(bad, "job"), doctest::Contains("x.state: "), vam::Error);
  bad = state;
  bad[bad.size() - 20] = static_cast<char>(bad[bad.size() - 20] ^ 1);
  CHECK_THROWS_WITH_AS(resume(bad, "job"), doctest::Contains("checksum"), vam::Error);
  const std::int64_t negative = -5;  // as the size of a list, among others
  for (std::size_t at = 0; at + sizeof negative <= 600; at += 4) {
    CAPTURE(at);
    bad = state;
    std::memcpy(bad.data() + at, &negative, sizeof negative);
    CHECK_THROWS_AS(resume(bad, "job"), vam::Error);
  }
}

#include "optimize/run/volume.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "base/error.hpp"
#include "base/json.hpp"
#include "lib/optimize/parts.hpp"
#include "light/shadowed.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/target/schedule.hpp"
#include "oracle/part_2d.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;

namespace {

constexpr int size = 64;
constexpr int angles = 90;

struct Written {
  std::vector<vam::Image> images;
  VolumeOutcome outcome;
};

Written run(const std::vector<std::vector<float>>& slices, VolumeTask task = {}) {
  const ParallelOperator light(parts::turn(size, angles));
  Written result;
  task.source.slices = static_cast<int>(slices.size());
  if (task.circle.radius == 0) task.circle = parts::circle(size);
  task.source.target = [&](int k, int count, float* out) {
    for (int i = 0; i < count; ++i)
      out = std::copy(slices[static_cast<std::size_t>(k + i)].begin(), slices[static_cast<std::size_t>(k + i)].end(),
                      out);
  };
  if (!task.make) task.make = [](double) { return make_method("dose-norm", {}); };
  task.write = [&](int k, const vam::Image& image) {
    CHECK(k == static_cast<int>(result.images.size()));
    result.images.push_back(image);
  };
  result.outcome = optimise(task, light);
  return result;
}

std::vector<float> dose_of(const vam::Image& image) {
  const auto turn = parts::turn(size, angles);
  Slab sinogram(size, angles);
  pack(image.values.data(), 1, sinogram);
  Slab dose(size, size);
  vam::tomo::adjoint(turn, {&sinogram, 1}, {&dose, 1});
  std::vector<float> values(size * size);
  unpack(dose, 1, values.data());
  for (float& v : values) v *= static_cast<float>(turn.angle_step_rad);
  return values;
}

/// Mean of IoU + PW over the slices, PW in parts of the threshold at which a slice prints best.
double quality(const std::vector<std::vector<float>>& slices, const std::vector<vam::Image>& images) {
  double sum = 0;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    const auto problem = make_problem(slices[k].data(), 1, size, size, parts::circle(size), {});
    Slab dose(size, size);
    pack(dose_of(images[k]).data(), 1, dose);
    const auto m = metrics({&dose, 1}, problem)[0];
    sum += m.iou + m.pw / m.iou_threshold;
  }
  return sum / static_cast<double>(slices.size());
}

}  // namespace

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
  for (int k = 0; k < 70; ++k) {
    slices.push_back(vam::oracle::draw(size, [=](double x, double y) { return std::hypot(x, y - 8) < 5 + 0.2 * k; }));
  }
  const auto all = run(slices);
  CHECK(all.outcome.jobs == 70);
  const auto alone = run({slices[66]});
  // The filter transforms two slices at a time, so a neighbour changes the rounding: a few ulp of the largest value.
  const auto& want = alone.images[0].values;
  const float largest = *std::max_element(want.begin(), want.end());
  float worst = 0;
  for (std::size_t i = 0; i < want.size(); ++i) worst = std::max(worst, std::abs(all.images[66].values[i] - want[i]));
  CHECK(worst < 1e-5F * largest);
}

TEST_CASE("a slice that the part only grazes is printed from half coverage on") {
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
    if (task.circle.contains(i % size, i / size)) filled[static_cast<std::size_t>(i)] = 1.0F;
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
  task.around = [](std::span<const Slab> inserts) {
    return std::make_unique<ShadowedOperator>(parts::turn(size, angles), 0, 32, inserts);
  };
  const auto result = run({outside}, task);
  CHECK(result.outcome.dark_part_voxels > 250);  // the disc of 314 pixels inside the ring, its rim being surface
  CHECK(result.outcome.dark_part_voxels < 314);
}

TEST_CASE("the loop stops at its goal, and when it stagnates") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size)};
  VolumeTask task;
  task.watch = true;
  task.make = [](double) { return make_method("cal", {}); };
  task.limits.iterations = 500;
  task.limits.until = vam::model::parse_conditions("iou>=0.9", {"ver", "pw", "ipdr", "cv", "iou"});
  const auto goal = run(slices, task);
  CHECK(goal.outcome.reason == "goal");
  CHECK(goal.outcome.trace.back().iou >= 0.9);
  CHECK(static_cast<int>(goal.outcome.trace.size()) == goal.outcome.iterations + 1);
  task.limits.until.clear();
  const auto stalled = run(slices, task);
  CHECK(stalled.outcome.reason == "no progress");
  CHECK(stalled.outcome.iterations < 500);
}

TEST_CASE("initial projections are used") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size)};
  VolumeTask task;
  task.limits.iterations = 20;
  task.make = [](double) { return make_method("cal", {}); };
  const auto first = run(slices, task);
  task.limits.iterations = 0;
  task.initial = [&](int k) { return first.images[static_cast<std::size_t>(k)]; };
  const auto again = run(slices, task);
  CHECK(again.outcome.metrics.pw == doctest::Approx(first.outcome.metrics.pw).epsilon(1e-4));
}

TEST_CASE("the schedule drops results that would be held too long") {
  std::vector<Digest> slices;
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
    Archive to(Archive::Way::out, "state",
               [&](void* bytes, std::size_t n) { next.append(static_cast<const char*>(bytes), n); });
    Archive from(Archive::Way::in, "state", [&](void* bytes, std::size_t n) {
      REQUIRE(read + n <= broken.state.size());
      std::copy_n(broken.state.data() + read, n, static_cast<char*>(bytes));
      read += n;
    });
    int left = steps;
    VolumeTask piece = task;
    piece.interruption = {[&] { return left-- == 0; }, &to, broken.times > 0 ? &from : nullptr, "job"};
    broken.result = run(slices, piece);
    if (broken.result.outcome.reason != "interrupted") return broken;
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
  CHECK_THROWS_WITH_AS(run(slices, task), doctest::Contains("--no-blur"), vam::Error);
}

TEST_CASE("a damaged state, and one of another job, are refused") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size)};
  VolumeTask task;
  task.limits.iterations = 5;
  task.make = [](double) { return make_method("apg", {}); };
  std::string state;
  Archive to(Archive::Way::out, "state",
             [&](void* bytes, std::size_t n) { state.append(static_cast<const char*>(bytes), n); });
  task.interruption = {[] { return true; }, &to, nullptr, "job"};
  REQUIRE(run(slices, task).outcome.reason == "interrupted");
  const auto resume = [&](const std::string& bytes, const std::string& job) {
    std::size_t read = 0;
    Archive from(Archive::Way::in, "x.state", [&](void* to_, std::size_t n) {
      REQUIRE(read + n <= bytes.size());
      std::copy_n(bytes.data() + read, n, static_cast<char*>(to_));
      read += n;
    });
    VolumeTask again = task;
    again.interruption = {{}, nullptr, &from, job};
    return run(slices, again);
  };
  CHECK(resume(state, "job").outcome.reason != "interrupted");
  CHECK_THROWS_WITH_AS(resume(state, "other"), doctest::Contains("x.state: is a checkpoint of another job"),
                       vam::Error);
  std::string bad = state;
  const float nan = std::nanf("");
  std::memcpy(bad.data() + bad.size() / 2 / 4 * 4, &nan, sizeof nan);  // in the middle of the doses
  CHECK_THROWS_WITH_AS(resume(bad, "job"), doctest::Contains("x.state: "), vam::Error);
  bad = state;
  bad[bad.size() - 20] = static_cast<char>(bad[bad.size() - 20] ^ 1);
  CHECK_THROWS_WITH_AS(resume(bad, "job"), doctest::Contains("checksum"), vam::Error);
}

TEST_CASE("intensity never exceeds its bound, whatever the final scale") {
  const std::vector<std::vector<float>> slices{vam::oracle::wheel(size), vam::oracle::resolution_target(size)};
  for (const std::string name : {"cal", "osmo", "pm", "bclp", "apg"}) {
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
  for (const std::string name : {"cal", "osmo", "pm", "bclp", "apg"}) {
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

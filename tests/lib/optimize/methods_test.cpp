// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text/text.hpp"
#include "lib/optimize/parts.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/methods/private/loss.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;

namespace {

constexpr int size = 192;

std::vector<std::vector<float>> some_parts() {
  return {vam::oracle::disc_grid(size, 0.65), vam::oracle::gyroid(size, 3, 0.7, 0.4), vam::oracle::wheel(size),
          vam::oracle::resolution_target(size)};
}

PerSlice losses(const std::vector<Slab>& dose, const Problem& problem) {
  return summed(dose, [&](std::size_t s, std::size_t i) {
    const float by = bounds(problem, problem.demands.window, s, i).miss(dose[s].values[i]);
    return 0.5F * problem.weight_at(s, i) * by * by;
  });
}

}  // namespace

TEST_CASE("OST22 fig S6: the process window widens with a background and again with one normalisation") {
  const auto parts = some_parts();
  const auto fbp = parts::run(parts, size, 360, "fbp", {}, 0);
  const auto background = parts::run(parts, size, 360, "dose-norm", {}, 0);
  const auto normalised = parts::run(parts, size, 360, "dose-norm", {}, 1);
  for (std::size_t s = 0; s < parts.size(); ++s) {
    CAPTURE(s);
    CHECK(background[s].pw > fbp[s].pw + 0.01);
    CHECK(normalised[s].pw > background[s].pw + 0.005);
  }
}

TEST_CASE("CAL19 fig S7: the resin's threshold in the loop") {
  const auto parts = some_parts();
  Demands linear;
  linear.curve = CureCurve::linear();
  const auto with = parts::run(parts, size, 360, "cal", {}, 20);
  const auto without = parts::run(parts, size, 360, "cal", {}, 20, linear);
  for (std::size_t s = 0; s < parts.size(); ++s) {
    CAPTURE(s);
    CHECK(with[s].pw > without[s].pw);
    CHECK(with[s].ver <= without[s].ver);
    CHECK(with[s].iou >= without[s].iou);
  }
}

TEST_CASE("cal: a sharper response than that of other methods opens the gaps of a resolution target") {
  const auto target = vam::oracle::resolution_target(size);
  const auto with = [&](double softness) {
    Demands demands;
    demands.curve = CureCurve::logistic(demands.window.threshold(), softness);
    return parts::run({target}, size, 360, "cal", {}, 59, demands)[0];
  };
  const auto own = with(method_entry("cal").softness);
  const auto usual = with(usual_softness);
  CHECK(own.ver == 0);
  CHECK(own.pw > usual.pw + 0.05);
}

TEST_CASE("apg: a binary resolution target prints exactly within 120 projections, with room to spare") {
  const auto target = vam::oracle::resolution_target(size);
  // 6 projections for the start, 12 for the step length, 2 an iteration.
  const auto m = parts::run({target}, size, 360, "apg", {}, 51)[0];
  CHECK(m.ver == 0.0);
  CHECK(m.pw >= 0.05);
}

TEST_CASE("apg never makes the loss worse until a slice prints, and then it stays printed, within its bounds") {
  const auto parts = some_parts();
  const auto all = parts::stacked(parts);
  const auto made = parts::parallel_light(size, 360);
  const vam::light::Operator& light = *made;
  Demands demands;
  demands.free_surface = true;  // no loss but the voxels'
  const auto problem = parts::make_problem(all.data(), 4, size, size, parts::circle(size), demands);
  const auto method = make_method("apg", MethodOptions{.max_intensity = 3});
  Iterate state;
  method->start(problem, light, state);
  PerSlice before = losses(state.dose, problem);
  auto slices = metrics(state.dose, problem);
  CHECK(std::count_if(slices.begin(), slices.end(), [](const auto& slice) { return slice.latitude <= 0; }) > 1);
  for (int i = 0; i < 20; ++i) {
    method->step(problem, light, state);
    const PerSlice now = losses(state.dose, problem);
    const auto next = metrics(state.dose, problem);
    for (std::size_t s = 0; s < 4; ++s)
      CHECK((slices[s].latitude > 0 ? next[s].latitude > 0 : now[0][s] <= before[0][s]));
    before = now;
    slices = next;
  }
  const float largest = *std::max_element(state.g[0].values.begin(), state.g[0].values.end());
  CHECK(largest <= static_cast<float>(3 * light.row_angle_rad()));
  const auto apg = metrics(state.dose, problem);
  const auto fbp = parts::run(parts, size, 360, "fbp", {}, 0);
  const auto normalised = parts::run(parts, size, 360, "dose-norm", {}, 1);
  for (std::size_t s = 0; s < 4; ++s) {
    CAPTURE(s);
    CHECK(apg[s].ver <= std::min(fbp[s].ver, normalised[s].ver));
    CHECK(apg[s].iou >= std::max(fbp[s].iou, normalised[s].iou));
  }
}

TEST_CASE("apg is at least as good as its better initial guess") {
  const auto parts = some_parts();
  const auto fbp = parts::run(parts, size, 360, "fbp", {}, 0);
  const auto normalised = parts::run(parts, size, 360, "dose-norm", {}, 1);
  for (const int iterations : {1, 2, 4, 8}) {
    CAPTURE(iterations);
    const auto apg = parts::run(parts, size, 360, "apg", {}, iterations);
    for (std::size_t s = 0; s < parts.size(); ++s) {
      CAPTURE(s);
      constexpr double rounding = 1e-6;  // each start is brought to the common threshold
      CHECK(apg[s].ver <= std::min(fbp[s].ver, normalised[s].ver) + rounding);
      CHECK(apg[s].pw >= std::max(fbp[s].pw, normalised[s].pw) - rounding);
      CHECK(apg[s].iou >= std::max(fbp[s].iou, normalised[s].iou) - rounding);
    }
  }
}

TEST_CASE("apg widens the window of an easy part further than a hard one's, which still prints") {
  const auto easy = vam::oracle::draw(96, [](double x, double y) { return std::hypot(x - 6, y) < 18; });
  const auto m = parts::run({easy, vam::oracle::resolution_target(96)}, 96, 180, "apg", {}, 40);
  CHECK(m[0].min_part - m[0].max_void > 0.15);  // it began with 0.1
  CHECK(m[0].pw > m[1].pw);
  CHECK(m[1].ver == 0.0);
}

TEST_CASE("osmo, pm and bclp widen the process window of fbp and leave fewer voxels wrong") {
  const auto parts = some_parts();
  const auto fbp = parts::run(parts, size, 360, "fbp", {}, 0);
  for (const std::string name : {"osmo", "pm", "bclp"}) {
    const auto m = parts::run(parts, size, 360, name, {}, 20);
    for (std::size_t s = 0; s < parts.size(); ++s) {
      CAPTURE(name);
      CAPTURE(s);
      CHECK(m[s].pw > fbp[s].pw + 0.02);
      CHECK(m[s].ver <= fbp[s].ver);
      CHECK(m[s].iou >= fbp[s].iou);
    }
  }
}

TEST_CASE("a steeper norm works as well, and the chosen step never makes pm's loss worse") {
  const auto part = vam::oracle::wheel(96);
  MethodOptions options{.power = 4};
  const auto fbp = parts::run({part}, 96, 180, "fbp", {}, 0)[0];
  CHECK(parts::run({part}, 96, 180, "pm", options, 20)[0].pw > fbp.pw);
  const auto made = parts::parallel_light(96, 180);
  const vam::light::Operator& light = *made;
  const auto problem = parts::make_problem(part.data(), 1, 96, 96, parts::circle(96), {});
  const auto method = make_method("pm", {});  // p = 2: twice the one-sided loss
  Iterate state;
  method->start(problem, light, state);
  float before = losses(state.dose, problem)[0][0];
  for (int i = 0; i < 15; ++i) {
    method->step(problem, light, state);
    const float now = losses(state.dose, problem)[0][0];
    CHECK(now <= before * 1.00001F);  // the same sum, rounded in another way
    before = now;
  }
}

TEST_CASE("osmo's and cal's loss never rises: osmo's by itself, cal's by line search") {
  const auto parts = some_parts();
  const auto all = parts::stacked(parts);
  const auto made = parts::parallel_light(size, 360);
  const vam::light::Operator& light = *made;
  const auto problem = parts::make_problem(all.data(), 4, size, size, parts::circle(size), {});
  const CureCurve& curve = problem.demands.curve;
  // cal's: the integral of M(x) - f, for part less its value at a dose of 2 so that 0 is the least.
  const auto cross = [&](std::size_t s, std::size_t i, float x) {
    if (!is_constrained(problem.labels[s][i])) return 0.0F;
    const float f = problem.target[s].values[i];
    return curve.area(x) - f * x - (f > 0 ? curve.area(2) - 2 * f : 0.0F);
  };
  for (const std::string name : {"osmo", "cal"}) {
    CAPTURE(name);
    const auto method = make_method(name, {});
    Iterate state;
    method->start(problem, light, state);
    const auto now = [&] {
      return name == "osmo" ? losses(state.dose, problem) : summed(state.dose, [&](std::size_t s, std::size_t i) {
        return cross(s, i, state.dose[s].values[i]);
      });
    };
    const PerSlice first = now();
    PerSlice before = first;
    for (int i = 0; i < 20; ++i) {
      method->step(problem, light, state);
      const PerSlice after = now();
      // The sum itself is only known to rounding: 1e-6 of what it began with.
      for (std::size_t s = 0; s < 4; ++s) CHECK(after[0][s] <= before[0][s] + 1e-6F * first[0][s]);
      before = after;
    }
    for (std::size_t s = 0; s < 4; ++s) CHECK(before[0][s] < 0.7F * first[0][s]);
  }
}

TEST_CASE("projections are never negative") {
  for (const auto& name : method_names()) {
    CAPTURE(name);
    const auto made = parts::parallel_light(64, 60);
    const vam::light::Operator& light = *made;
    const auto part = vam::oracle::wheel(64);
    const auto problem = parts::make_problem(part.data(), 1, 64, 64, parts::circle(64), {});
    Iterate state;
    run_method(*make_method(name, {}), problem, light, {.iterations = 3, .until = {}, .patience = 0}, state);
    CHECK(*std::min_element(state.g[0].values.begin(), state.g[0].values.end()) >= 0.0F);
  }
}

TEST_CASE("offset projections keep the shape of the filtered ones") {
  const auto m = parts::run({vam::oracle::wheel(64)}, 64, 90, "fbp", MethodOptions{.offset = true}, 0)[0];
  // Back-projecting the constant adds the same dose everywhere in the circle, so only the contrast suffers.
  CHECK(m.cv < parts::run({vam::oracle::wheel(64)}, 64, 90, "fbp", {}, 0)[0].cv);
}

TEST_CASE("the methods that read --robust are those that face other printers") {
  for (const MethodEntry& entry : method_table()) {
    CAPTURE(entry.name);
    CHECK(reads(entry, "--robust") == (entry.make_robust != nullptr));
  }
}

TEST_CASE("contradictory thresholds and unknown methods are refused") {
  Demands demands{.window = {0.9, 0.7}};
  CHECK_THROWS_WITH_AS(check(demands), doctest::Contains("0.9, is not below the least part dose, 0.7"), vam::Error);
  const std::string known = "there are " + vam::join(method_names(), ", ");
  CHECK_THROWS_WITH_AS(make_method("magic", {}), doctest::Contains(known.c_str()), vam::Error);
}

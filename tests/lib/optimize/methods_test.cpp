#include <doctest/doctest.h>

#include <algorithm>

#include "base/error.hpp"
#include "oracle/part_2d.hpp"
#include "parts.hpp"

using namespace vam::optimize;

namespace {

constexpr int size = 192;

std::vector<std::vector<float>> some_parts() {
  return {oracle::disc_grid(size, 0.65), oracle::gyroid(size, 3, 0.7, 0.4), oracle::wheel(size),
          oracle::resolution_target(size)};
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
  MethodOptions linear;
  linear.thresholding = false;
  const auto with = parts::run(parts, size, 360, "cal", {}, 20);
  const auto without = parts::run(parts, size, 360, "cal", linear, 20);
  for (std::size_t s = 0; s < parts.size(); ++s) {
    CAPTURE(s);
    CHECK(with[s].pw > without[s].pw);
    CHECK(with[s].ver <= without[s].ver);
    CHECK(with[s].iou >= without[s].iou);
  }
}

TEST_CASE("projections are never negative") {
  for (const auto& name : method_names()) {
    CAPTURE(name);
    const ParallelOperator light(parts::turn(64, 60));
    const auto part = oracle::wheel(64);
    const auto problem = make_problem(part.data(), 1, 64, 64, parts::circle(64), {});
    Iterate state;
    iterate(*make_method(name, {}), problem, light, {.iterations = 3, .until = {}, .patience = 0}, state);
    CHECK(*std::min_element(state.g[0].values.begin(), state.g[0].values.end()) >= 0.0F);
  }
}

TEST_CASE("offset projections keep the shape of the filtered ones") {
  MethodOptions offset;
  offset.offset = true;
  const auto m = parts::run({oracle::wheel(64)}, 64, 90, "fbp", offset, 0)[0];
  // Back-projecting the constant adds the same dose everywhere in the circle, so only the contrast suffers.
  CHECK(m.cv < parts::run({oracle::wheel(64)}, 64, 90, "fbp", {}, 0)[0].cv);
}

TEST_CASE("contradictory thresholds and unknown methods are refused") {
  MethodOptions options;
  options.window = {0.9, 0.7};
  CHECK_THROWS_WITH_AS(make_method("cal", options), doctest::Contains("0.9 is not below --dose-high 0.7"), vam::Error);
  CHECK_THROWS_WITH_AS(make_method("magic", {}), doctest::Contains("there are fbp, dose-norm, cal"), vam::Error);
}

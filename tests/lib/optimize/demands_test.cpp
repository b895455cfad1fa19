// SPDX-License-Identifier: GPL-3.0-or-later
#include "lib/optimize/parts.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/methods/private/loss.hpp"
#include "optimize/target/surface_band.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;

namespace {

constexpr int size = 96;

long count(const Problem& problem, Label label) {
  long n = 0;
  for (std::size_t i = 0; i < problem.labels[0].size(); i += lanes) n += problem.labels[0][i] == label ? 1 : 0;
  return n;
}

Problem problem_of(const std::vector<float>& slice, const Demands& demands, const std::vector<float>& weight = {},
                   const std::vector<float>& tolerance = {}) {
  return parts::make_problem(slice.data(), 1, size, size, parts::circle(size), demands,
                             weight.empty() ? nullptr : weight.data(), tolerance.empty() ? nullptr : tolerance.data());
}

Iterate solve(const Problem& problem, const std::string& name, int iterations) {
  const auto made = parts::parallel_light(size, 180);
  const vam::light::Operator& light = *made;
  Iterate state;
  run_method(*make_method(name, {}), problem, light, {.iterations = iterations, .until = {}, .patience = 0}, state);
  return state;
}

/// Sum over the constrained voxels of a half plane of the squared distance to the window.
double cost(const Iterate& state, const Problem& problem, bool right) {
  double sum = 0;
  for (int y = 0; y < size; ++y) {
    for (int x = right ? size / 2 : 0; x < (right ? size : size / 2); ++x) {
      const auto i = static_cast<std::size_t>((y * size + x) * lanes);
      const float miss = bounds(problem, problem.demands.window, 0, i).miss(state.dose[0].values[i]);
      sum += static_cast<double>(miss) * static_cast<double>(miss);
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("surface voxels are left out by default, else part from half coverage on") {
  const auto disc = vam::oracle::draw(size, [](double x, double y) { return std::hypot(x, y) < 20.3; });
  Demands demands;
  const auto left_out = problem_of(disc, demands);
  demands.surface = true;
  const auto asked_too = problem_of(disc, demands);
  CHECK(count(left_out, Label::surface) > 100);
  CHECK(count(asked_too, Label::surface) == 0);
  long half = 0;
  for (const float v : disc) half += v >= 0.5F ? 1 : 0;
  CHECK(count(asked_too, Label::part) == half);
}

TEST_CASE("the band around the surface: every voxel against every other") {
  const int n = 14;
  const int slices = 9;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<float> volume(static_cast<std::size_t>(n * n * slices));
  const auto at = [&](int x, int y, int z) -> float& { return volume[(z * n + y) * n + x]; };
  for (int z = 0; z < slices; ++z) {  // a ball and grains
    for (const auto [y, x] : indices(n, n)) {
      const bool ball = std::hypot(x - 6.0, y - 7.0, z - 4.0) < 3.6;
      at(x, y, z) = ball != (uniform(random) < 0.004F) ? 0.8F : 0.3F;
    }
  }
  for (const double reach : {0.5, 1.0, 1.47, 1.8, 3.0}) {
    CAPTURE(reach);
    const SurfaceBand band(
        [&](int k, int many, float* out) { std::copy_n(&at(0, 0, k), static_cast<std::size_t>(many * n * n), out); },
        slices, n, n, reach);
    int wrong = 0;
    for (int z = 0; z < slices; ++z) {
      std::vector<float> weight(static_cast<std::size_t>(n * n), 1.0F);
      band.clear(z, weight.data());
      for (const auto [y, x] : indices(n, n)) {
        double nearest = 1e9;  // the surface is midway to the nearest voxel of the other kind
        for (const auto [w, v, u] : indices(slices, n, n)) {
          if ((at(u, v, w) >= 0.5F) != (at(x, y, z) >= 0.5F)) {
            nearest = std::min(nearest, std::hypot(u - x, v - y, w - z));
          }
        }
        const bool free = weight[y * n + x] == 0.0F;
        if (free != (nearest - 0.5 <= reach + 1e-6)) ++wrong;
      }
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("weights: voxels of weight 0 are unconstrained, and errors move to where they cost less") {
  const auto target = vam::oracle::resolution_target(size);
  std::vector<float> weight(target.size(), 1.0F);
  for (const auto [y, x] : indices(size, size)) {
    if (x >= size / 2) weight[y * size + x] = 0.02F;
  }
  // Few angles and a wide window, so that errors remain.
  Demands demands{.window = {0.5, 1.1}};
  const auto even = problem_of(target, demands);
  const auto left = problem_of(target, demands, weight);
  for (const std::string name : {"apg", "pm"}) {
    CAPTURE(name);
    const auto a = solve(even, name, 25);
    const auto b = solve(left, name, 25);
    CHECK(cost(b, left, false) < 0.9 * cost(a, even, false));
    CHECK(cost(b, left, true) > cost(a, even, true));
  }
  for (float& w : weight) w = w < 1 ? 0.0F : 3.0F;  // only ratios count
  const auto half = problem_of(target, demands, weight);
  CHECK(count(half, Label::surface) > size * size / 3);
  CHECK(*std::max_element(half.weight[0].values.begin(), half.weight[0].values.end()) == 1.0F);
}

TEST_CASE("a grey target: each voxel's dose within its own tolerance") {
  // A ring, hard on one side and soft on the other, in a void that may have up to 0.6; the edges are unconstrained.
  std::vector<float> target(static_cast<std::size_t>(size * size), 0.3F);
  std::vector<float> tolerance(target.size(), 0.3F);
  std::vector<float> weight(target.size(), 1.0F);
  for (const auto [y, x] : indices(size, size)) {
    const double u = x - 0.5 * (size - 1);
    const double r = std::hypot(u, y - 0.5 * (size - 1));
    const auto i = static_cast<std::size_t>(y * size + x);
    const bool ring = r > 12 && r < 32;
    if (ring) target[i] = u > 0 ? 0.7F : 1.0F;
    if (ring) tolerance[i] = 0.05F;
    if (std::abs(r - 12) < 1.5 || std::abs(r - 32) < 1.5 || (ring && std::abs(u) < 1.5)) weight[i] = 0.0F;
  }
  Demands demands;
  demands.grey = true;
  demands.curve = CureCurve::linear();
  const auto problem = problem_of(target, demands, weight, tolerance);
  const auto fbp = metrics(solve(problem, "fbp", 0).dose, problem)[0];
  CHECK(fbp.pw < -0.1);  // so far outside is the worst voxel
  for (const std::string& name : method_names([](const MethodEntry& method) { return method.grey; })) {
    CAPTURE(name);
    const auto m = metrics(solve(problem, name, 80).dose, problem)[0];
    MESSAGE(name << ": outside " << m.ver << ", worst by " << -m.pw << " (fbp " << fbp.ver << ", " << -fbp.pw << ")");
    CHECK(m.pw > 0.3 * fbp.pw);
    if (name == "apg") CHECK(m.ver < 0.5 * fbp.ver);
  }
}

TEST_CASE("response curves: slope and area are derivative and integral, doses() the inverse") {
  const std::vector<CureCurve> curves{CureCurve::linear(), CureCurve::step(0.7, 0.9), CureCurve::logistic(0.8, 0.05),
                                      CureCurve::table({{0.2, 0}, {0.6, 0.1}, {0.9, 0.8}, {1.3, 1}})};
  for (std::size_t c = 0; c < curves.size(); ++c) {
    CAPTURE(c);
    const CureCurve& curve = curves[c];
    const float h = 1e-2F;
    for (float dose = 0.055F; dose < 1.5F; dose += 0.1F) {  // not on a corner
      CAPTURE(dose);
      CHECK(curve.slope(dose) ==
            doctest::Approx((curve.response(dose + h) - curve.response(dose - h)) / (2 * h)).epsilon(0.02).scale(1));
      CHECK(curve.response(dose) ==
            doctest::Approx((curve.area(dose + h) - curve.area(dose - h)) / (2 * h)).epsilon(0.02).scale(1));
    }
    for (const float wanted : {0.0F, 0.3F, 0.6F, 1.0F}) {
      const DoseRange b = curve.doses(wanted, 0.1F);
      CAPTURE(wanted);
      if (std::isfinite(b.low)) CHECK(curve.response(b.low) == doctest::Approx(wanted - 0.1F).epsilon(1e-4));
      if (std::isfinite(b.high)) CHECK(curve.response(b.high) == doctest::Approx(wanted + 0.1F).epsilon(1e-4));
      CHECK(b.low < b.high);
    }
  }
  CHECK(std::isinf(curves[2].doses(1, 0.1F).high));
  CHECK(curves[1].doses(1, 0).low == 0.9F);
  CHECK_THROWS_WITH_AS(CureCurve::table({{0.2, 0}, {0.1, 1}}), doctest::Contains("falls back"), vam::Error);
  CHECK_THROWS_WITH_AS(CureCurve::table({{0.2, 0.5}, {0.4, 0.2}}), doctest::Contains("falls back"), vam::Error);
}

TEST_CASE("bclp widens the process window of fbp with any response curve") {
  const auto part = vam::oracle::wheel(size);
  const auto fbp = parts::run({part}, size, 180, "fbp", {}, 0)[0];
  Demands demands;
  for (const auto& curve : {CureCurve::step(0.75, 0.85), CureCurve::logistic(0.8, 0.1),
                            CureCurve::table({{0.3, 0}, {0.7, 0.1}, {0.9, 0.9}, {1.4, 1}})}) {
    demands.curve = curve;
    CHECK(parts::run({part}, size, 180, "bclp", {}, 30, demands)[0].pw > fbp.pw + 0.05);
  }
}

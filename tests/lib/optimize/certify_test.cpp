// SPDX-License-Identifier: GPL-3.0-or-later
// trials: 1000 -tc=no method's light is better*
// The proof of how good any light could be: held by light that is tried, by the exact optimum, and ray by ray.
#include "optimize/run/certify.hpp"

#include <cstdlib>
#include <span>

#include "lib/optimize/parts.hpp"
#include "optimize/methods/metrics.hpp"
#include "oracle/part_2d.hpp"
#include "oracle/simplex.hpp"
#include "testing.hpp"
#include "trials.hpp"

using namespace vam;
using namespace vam::optimize;

namespace {

struct Case {
  int size, angles;
  std::vector<float> part;
  std::unique_ptr<light::Operator> light = parts::parallel_light(size, angles);
  Problem problem = parts::make_problem(part.data(), 1, size, size, parts::circle(size), {});

  [[nodiscard]] std::vector<Slab> light_of(const char* method, int iterations) const {
    Iterate state;
    const auto made = make_method(method, {});
    run_method(*made, problem, *light, {.iterations = iterations, .until = {}, .patience = 0}, state);
    return state.g;
  }
};

/// The checker: A z - A y of every ray from the doses of single rays, sum z and sum y, all in double. Returns sum y,
/// or -1 where the weights prove nothing.
double checked(const Case& it, const Certificate& proof) {
  double y = 0, z = 0;
  for (std::size_t i = 0; i < proof.weights[0].values.size(); i += lanes) {
    const auto weight = static_cast<double>(proof.weights[0].values[i]);
    const Label label = it.problem.labels[0][i];
    if (weight > 0 && label != Label::void_) return -1;
    if (weight < 0 && label != Label::part) return -1;
    (weight > 0 ? z : y) += std::abs(weight);
  }
  for (const auto& dose : parts::ray_doses(*it.light)) {
    double balance = 0;
    for (std::size_t i = 0; i < dose.size(); ++i) {
      balance += dose[i] * static_cast<double>(proof.weights[0].values[i * lanes]);
    }
    if (balance < -1e-7) return -1;  // rounding of weights around 1e-2
  }
  return z < 1 + 1e-5 ? y / z : -1;
}

/// max t: D_part >= t, D_void <= 1, g >= 0, by the dense simplex; 1 / t. Bounds differ by up to 1e-5, so that no two
/// of them meet in one corner.
double exact(const Case& it) {
  const auto doses = parts::ray_doses(*it.light);
  oracle::LinearProgram program;
  program.cost.assign(doses.size() + 1, 0.0);
  program.cost.back() = -1;
  for (std::size_t i = 0; i < doses[0].size(); ++i) {
    const Label label = it.problem.labels[0][i * lanes];
    if (!is_constrained(label)) continue;
    const double sign = label == Label::part ? -1 : 1;
    std::vector<double>& row = program.a.emplace_back();
    for (const auto& dose : doses) row.push_back(sign * dose[i]);
    row.push_back(label == Label::part ? 1 : 0);
    const double aside = 1e-5 * static_cast<double>(i * 37 % 101) / 101;
    program.b.push_back((label == Label::part ? 0 : 1) + aside);
  }
  const auto optimum = oracle::minimise(program);
  REQUIRE(optimum);
  return -1 / optimum->value;
}

/// A whose sums are off by rounding, 1e-7 of the largest, as those of transforms are.
class Rounding final : public light::Operator {
 public:
  explicit Rounding(const light::Operator& exact) : exact_(exact) {}
  [[nodiscard]] light::Shape object() const override { return exact_.object(); }
  [[nodiscard]] light::Shape sinogram() const override { return exact_.sinogram(); }
  [[nodiscard]] light::Shape image() const override { return exact_.image(); }
  [[nodiscard]] double row_angle_rad() const override { return exact_.row_angle_rad(); }
  void forward(std::span<const Slab> objects, std::span<Slab> sinograms) const override {
    exact_.forward(objects, sinograms);
    for (Slab& slab : sinograms) {
      float largest = 0;
      for (const float v : slab.values) largest = std::max(largest, std::abs(v));
      for (float& v : slab.values) v -= 1e-7F * largest;
    }
  }
  void adjoint(std::span<const Slab> sinograms, std::span<Slab> objects) const override {
    exact_.adjoint(sinograms, objects);
  }
  void filter(std::span<Slab> sinograms) const override { exact_.filter(sinograms); }
  void precondition(std::span<Slab> sinograms) const override { exact_.precondition(sinograms); }

 private:
  const light::Operator& exact_;
};

/// A resolution target in a ring that reaches the circle's edge, where rays meet no void.
std::vector<float> ringed_target() {
  std::vector<float> part = oracle::resolution_target(32);
  for (int i = 0; i < 32 * 32; ++i) {
    const double r = std::hypot(i % 32 - 15.5, i / 32 - 15.5);
    if (r > 12) part[static_cast<std::size_t>(i)] = 1;
  }
  return part;
}

std::vector<float> random_part(int size, std::mt19937& random) {
  std::vector<float> part(static_cast<std::size_t>(size) * size, 0.0F);
  std::uniform_real_distribution<double> at(-0.3 * size, 0.3 * size), radius(0.05 * size, 0.18 * size);
  const double middle = 0.5 * (size - 1);
  for (int disc = 0; disc < 4; ++disc) {
    const double x = at(random), y = at(random), r = radius(random);
    for (int i = 0; i < size * size; ++i) {
      if (std::hypot(i % size - middle - x, i / size - middle - y) < r) part[static_cast<std::size_t>(i)] = 1;
    }
  }
  return part;
}

}  // namespace

TEST_CASE("the bound is below the exact optimum of the linear program, and near it") {
  std::mt19937 random(3);
  const Case it{12, 8, random_part(12, random)};
  const Certificate proof = certify(it.problem, *it.light, it.light_of("apg", 20), 400);
  const double best = exact(it);
  CHECK(proof.least <= best * (1 + 1e-4));
  CHECK(proof.least > 0.9 * best);
  CHECK(proof.reached >= best * (1 - 1e-4));
  CHECK(checked(it, proof) == doctest::Approx(proof.least).epsilon(1e-4));
}

TEST_CASE("part voxels on rays that meet no void have weight 0, and the bound on the rest holds") {
  const Case it{32, 24, ringed_target()};
  const Certificate proof = certify(it.problem, *it.light, it.light_of("apg", 20));
  CHECK(proof.least > 0.1);
  CHECK(checked(it, proof) == doctest::Approx(proof.least).epsilon(1e-4));
}

TEST_CASE("rounding on rays that meet no void does not spoil the bound") {
  const Case it{32, 24, ringed_target()};
  const Certificate proof = certify(it.problem, Rounding(*it.light), it.light_of("apg", 20));
  CHECK(proof.least > 0.1);
  CHECK(checked(it, proof) == doctest::Approx(proof.least).epsilon(1e-4));
}

// VAM_TRIALS random parts, 6 by default; ctest --preset long has 1000.
TEST_CASE("no method's light is better than the bound") {
  std::mt19937 random(13);
  const int parts = trials_or(6);
  for (int part = 0; part < parts; ++part) {
    CAPTURE(part);
    const Case it{32, 24, random_part(32, random)};
    const Certificate proof = certify(it.problem, *it.light, it.light_of("apg", 20));
    CHECK(proof.least > 0);
    CHECK(checked(it, proof) == doctest::Approx(proof.least).epsilon(1e-4));
    for (const std::string& method : method_names()) {
      CAPTURE(method);
      Iterate state;
      run_method(*make_method(method, {}), it.problem, *it.light, {.iterations = 20, .until = {}, .patience = 0},
                 state);
      const auto m = metrics(state.dose, it.problem)[0];
      CHECK(m.max_void >= proof.least * m.min_part * (1 - 1e-5));
    }
  }
}

TEST_CASE("the bound of a resolution target is near the optimised ratio") {
  const Case it{64, 90, oracle::resolution_target(64)};
  const Certificate proof = certify(it.problem, *it.light, it.light_of("apg", 40));
  CHECK(proof.least > 0.95 * proof.reached);
  CHECK(proof.least <= proof.reached);
  CHECK(checked(it, proof) == doctest::Approx(proof.least).epsilon(1e-4));
}

// SPDX-License-Identifier: GPL-3.0-or-later
// The widest window that limited light can have: against the exact linear program, and against apg.
#include "lib/optimize/parts.hpp"
#include "optimize/run/even_dose.hpp"
#include "oracle/part_2d.hpp"
#include "oracle/simplex.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;

namespace {

struct Case {
  int size, angles;
  std::vector<float> part;
  double of_even;  // the limit
  std::unique_ptr<light::Operator> light = parts::parallel_light(size, angles);
  Problem problem = parts::make_problem(part.data(), 1, size, size, parts::circle(size), free_surface());

  static Demands free_surface() {
    Demands demands{.free_surface = true};
    return demands;
  }
  [[nodiscard]] double threshold() const { return problem.demands.window.threshold(); }
  [[nodiscard]] MethodOptions options(double limit) const {
    MethodOptions options{.max_intensity = limit * threshold() / even_dose(*light, parts::circle(size), lanes).mean};
    return options;
  }
};

struct Reached {
  double ratio = 0, provable = 0, peak = 0;
};

Reached run(const Case& it, const std::string& name, int iterations) {
  const auto method = make_method(name, it.options(it.of_even));
  Iterate state;
  run_method(*method, it.problem, *it.light, {.iterations = iterations, .until = {}, .patience = 0}, state);
  const auto m = metrics(state.dose, it.problem)[0];
  const float peak = *std::max_element(state.g[0].values.begin(), state.g[0].values.end());
  const float least = *std::min_element(state.g[0].values.begin(), state.g[0].values.end());
  CHECK(least >= 0);
  return {m.max_void / m.min_part, method->provable_ratio(), static_cast<double>(peak) / it.light->row_angle_rad()};
}

/// max h: x >= t + h in the part, x <= t - h in the void, 0 <= g <= peak, by the dense simplex; (t - h) / (t + h).
/// Its unknowns are not negative: the last one is 1 + h. Bounds differ by up to 1e-5, so that no two of them meet in
/// one corner.
double exact(const Case& it) {
  const auto doses = parts::ray_doses(*it.light);
  const double peak = it.options(it.of_even).max_intensity * it.light->row_angle_rad();
  const double t = it.threshold();
  oracle::LinearProgram program;
  program.cost.assign(doses.size() + 1, 0.0);
  program.cost.back() = -1;
  for (std::size_t i = 0; i < doses[0].size(); ++i) {
    const Label label = it.problem.labels[0][i * lanes];
    if (!is_constrained(label)) continue;
    const double sign = label == Label::part ? -1 : 1;
    std::vector<double>& row = program.a.emplace_back();
    for (const auto& dose : doses) row.push_back(sign * dose[i]);
    row.push_back(1);
    program.b.push_back(1 + sign * t + 1e-5 * static_cast<double>(i * 37 % 101) / 101);
  }
  for (std::size_t ray = 0; ray < doses.size(); ++ray) {
    program.a.emplace_back(doses.size() + 1, 0.0)[ray] = 1;
    program.b.push_back(peak);
  }
  const auto optimum = oracle::minimise(program);
  REQUIRE(optimum);
  const double h = -1 - optimum->value;
  return (t - h) / (t + h);
}

/// Two discs and a bar.
std::vector<float> small_part() {
  auto part = oracle::draw(12, [](double x, double y) {
    return std::hypot(x - 2.5, y) < 1.6 || std::hypot(x + 2.5, y - 1) < 1.2 || (std::abs(y + 3) < 0.6 && x * x < 9);
  });
  for (float& v : part) v = v >= 0.5F ? 1.0F : 0.0F;
  return part;
}

}  // namespace

TEST_CASE("minimax reaches the exact optimum of limited light, and states a bound that no light passes") {
  for (const double of_even : {1.2, 1.5, 2.0}) {
    CAPTURE(of_even);
    const Case it{12, 8, small_part(), of_even};
    const double best = exact(it);
    const Reached reached = run(it, "minimax", 400);
    MESSAGE(best << " " << reached.ratio << " " << reached.provable);
    CHECK(reached.ratio >= best * (1 - 1e-4));
    CHECK(reached.ratio <= best * 1.005);
    CHECK(reached.provable <= best * (1 + 1e-4));
    CHECK(reached.provable >= best * 0.995);
    CHECK(reached.peak <= it.options(of_even).max_intensity * (1 + 1e-6));
  }
}

TEST_CASE("minimax has a wider window than apg at equal limit, within its bound") {
  const Case it{96, 120, oracle::resolution_target(96), 1.5};
  const Reached apg = run(it, "apg", 200);
  const Reached widest = run(it, "minimax", 200);
  MESSAGE(apg.ratio << " " << widest.ratio << " " << widest.provable);
  CHECK(apg.provable == 0);
  CHECK(widest.ratio < apg.ratio - 0.02);
  CHECK(widest.ratio >= widest.provable);
  CHECK(apg.ratio >= widest.provable);
  CHECK(widest.provable > 0.97 * widest.ratio);
}

TEST_CASE("the bound is that of the limit in force") {
  const Case it{12, 8, small_part(), 1.2};
  const auto method = make_method("minimax", it.options(1.2));
  Iterate state;
  run_method(*method, it.problem, *it.light, {.iterations = 200, .until = {}, .patience = 0}, state);
  const double tight = method->provable_ratio();
  method->allow(it.options(2).max_intensity);
  for (int i = 0; i < 200; ++i) method->step(it.problem, *it.light, state);
  const double best = exact({12, 8, small_part(), 2.0});
  CHECK(best < 0.99 * tight);
  CHECK(method->provable_ratio() <= best * (1 + 1e-4));
  CHECK(method->provable_ratio() > 0.97 * best);
}

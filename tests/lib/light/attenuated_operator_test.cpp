// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/attenuated_operator.hpp"

#include "lib/light/operator_checks.hpp"
#include "lib/optimize/parts.hpp"
#include "light/operators/private/parallel_operator.hpp"
#include "optimize/methods/metrics.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;
using parts::dot;

TEST_CASE("A and A* are adjoint with absorption, and the preconditioner is symmetric") {
  const AttenuatedOperator light(parts::turn(64, 90), 1.0 / 32, 32);
  CHECK(parts::adjoint_error(light) < 1e-5);
  parts::check_preconditioner(light);
}

TEST_CASE("a single beam decays from where it enters the resin") {
  const int size = 65;
  const double mu = 0.05;
  const double radius = 32;
  const AttenuatedOperator light(parts::turn(size, 4), mu, radius);  // angle 0: columns along x, light along +y
  Slab g(size, 4);
  const int column = 40;  // t = 8
  *g.at(column, 0) = 1;
  Slab dose(size, size);
  light.adjoint({&g, 1}, {&dose, 1});
  for (const int y : {10, 32, 50}) {
    const double s = std::sqrt(radius * radius - 8.0 * 8.0) + (y - 32);
    CHECK(static_cast<double>(*dose.at(column, y)) == doctest::Approx(std::exp(-mu * s)).epsilon(0.01));
  }
}

TEST_CASE("unclipped inverse projections give the disc in spite of absorption; the disc normalisation is approximate") {
  const int size = 128;
  const double radius = 64;
  const auto disc = vam::oracle::draw(size, [](double x, double y) { return std::hypot(x - 20, y + 5) < 20; });
  const Slab f = parts::packed(disc, size);
  const auto ratio = [&](Correction correction, double mu) {  // dose at the disc's inner over its outer side
    const AttenuatedOperator light(parts::turn(size, 360), mu, radius, correction);
    Slab g(light.sinogram().width, light.sinogram().height);
    light.invert({&f, 1}, {&g, 1});
    Slab dose(size, size);
    light.adjoint({&g, 1}, {&dose, 1});
    return static_cast<double>(*dose.at(71, 58)) / static_cast<double>(*dose.at(96, 58));
  };
  CHECK(ratio(Correction::exact, 1 / radius) == doctest::Approx(1.0).epsilon(0.02));
  CHECK(ratio(Correction::disc, 0.3 / radius) == doctest::Approx(1.0).epsilon(0.05));
}

TEST_CASE("1/mu = R: a gyroid keeps its process window when absorption is in the loop, not when it is left out") {
  const int size = 128;
  const auto part = vam::oracle::gyroid(size, 3, 0.7, 0.5);
  const auto turn = parts::turn(size, 360);
  const auto problem = parts::make_problem(part.data(), 1, size, size, parts::circle(size), {});
  const ParallelOperator clear(turn);
  const AttenuatedOperator absorbing(turn, 2.0 / size, size / 2.0);
  const auto solve = [&](const Operator& light, Iterate& state) {
    const auto method = make_method("apg", {});
    run_method(*method, problem, light, {.iterations = 40, .until = {}, .patience = 0}, state);
    return metrics(state.dose, problem)[0].pw;
  };
  Iterate without;
  Iterate with;
  const double clear_pw = solve(clear, without);
  const double absorbing_pw = solve(absorbing, with);
  Slab image(size, 360);
  clear.expand(without.g[0], image);
  Iterate left_out{.g = slabs(1, size, 360), .dose = slabs(1, size, size)};
  absorbing.collapse(image, left_out.g[0]);
  absorbing.adjoint(left_out.g, left_out.dose);
  const double left_out_pw = metrics(left_out.dose, problem)[0].pw;
  MESSAGE("PW clear " << clear_pw << ", absorbing " << absorbing_pw << ", absorption left out " << left_out_pw);
  CHECK(absorbing_pw >= 0.6 * clear_pw);
  CHECK(left_out_pw < absorbing_pw);
}

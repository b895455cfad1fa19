// SPDX-License-Identifier: GPL-3.0-or-later
#include <doctest/doctest.h>

#include <cmath>

#include "lib/light/operator_checks.hpp"
#include "lib/optimize/parts.hpp"
#include "light/operators/private/parallel_operator.hpp"
#include "oracle/part_2d.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;
using parts::dot;

TEST_CASE("A and A* are adjoint, with half the rows and with all") {
  CHECK(parts::adjoint_error(ParallelOperator(parts::turn(64, 90))) < 1e-5);
  CHECK(parts::adjoint_error(ParallelOperator(parts::turn(65, 91))) < 1e-5);
}

TEST_CASE("the preconditioner is symmetric and positive") {
  parts::check_preconditioner(ParallelOperator(parts::turn(64, 90)));
}

TEST_CASE("an even turn needs half the rows; the projected image gives the same dose") {
  const auto turn = parts::turn(64, 90);
  const ParallelOperator light(turn);
  REQUIRE(light.sinogram().height == 45);
  const Slab g = parts::noise(light.sinogram(), 5);
  Slab image(light.image().width, light.image().height);
  light.expand(g, image);
  Slab dose(64, 64);
  light.adjoint({&g, 1}, {&dose, 1});
  Slab whole(64, 64);
  vam::tomo::adjoint(turn, {&image, 1}, {&whole, 1});
  double worst = 0;
  for (std::size_t i = 0; i < dose.values.size(); ++i) {
    worst = std::max(worst, std::abs(static_cast<double>(dose.values[i]) -
                                     turn.angle_step_rad * static_cast<double>(whole.values[i])));
  }
  CHECK(worst < 1e-4);  // of values of order 5, in float
  Slab back(light.sinogram().width, light.sinogram().height);
  light.collapse(image, back);
  CHECK(std::sqrt(dot(back, back)) == doctest::Approx(std::sqrt(dot(g, g))).epsilon(1e-6));
}

TEST_CASE("A* filter A is about the identity: unclipped filtered back-projection of a disc") {
  parts::check_disc_comes_back(ParallelOperator(parts::turn(128, 360)), 0.005,
                               0.01);  // [KS88]: the ramp keeps the mean
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "lib/light/operator_checks.hpp"
#include "lib/optimize/parts.hpp"
#include "light/operators/private/parallel_operator.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;
using parts::dot;

TEST_CASE("A and A* are adjoint, with half the rows and with all") {
  CHECK(parts::adjoint_error(ParallelOperator(parts::turn(64, 90))) < 1e-5);
  CHECK(parts::adjoint_error(ParallelOperator(parts::turn(65, 91))) < 1e-5);
}

TEST_CASE("A and A* are adjoint by Fourier slices, too, and about those of the footprints") {
  for (const auto turn : {parts::turn(64, 90), parts::turn(65, 91)}) {
    const ParallelOperator light(turn, LineIntegrals::fourier);
    CHECK(parts::adjoint_error(light) < 1e-5);
    parts::check_disc_comes_back(ParallelOperator(parts::turn(128, 360), LineIntegrals::fourier), 0.005, 0.01);
  }
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
  for (std::size_t i = 0; i < dose.values.size(); ++i) {
    CHECK(std::abs(static_cast<double>(dose.values[i]) - turn.angle_step_rad * static_cast<double>(whole.values[i])) <
          1e-4);  // of values of order 5, in float
  }
  Slab back(light.sinogram().width, light.sinogram().height);
  light.collapse(image, back);
  CHECK(std::sqrt(dot(back, back)) == doctest::Approx(std::sqrt(dot(g, g))).epsilon(1e-6));
}

TEST_CASE("A* filter A is about the identity: unclipped filtered back-projection of a disc") {
  parts::check_disc_comes_back(ParallelOperator(parts::turn(128, 360)), 0.005,
                               0.01);  // [KS88]: the ramp keeps the mean
}

TEST_CASE("a single slice is lit by four copies of it at an eighth of the angles") {
  for (const auto& [size, angles] : {std::pair{64, 96}, {65, 360}, {32, 8}}) {
    CAPTURE(size);
    const ParallelOperator light(parts::turn(size, angles));
    const auto quicker = light.for_one_slice();
    REQUIRE(quicker != nullptr);
    const auto first_lane = [](Slab slab) {
      for (std::size_t i = 0; i < slab.values.size(); ++i)
        if (i % lanes != 0) slab.values[i] = 0;
      return slab;
    };
    // Values of order 10 from a few dozen of order 1, in float, in another order of summation.
    const auto difference = [](const Slab& a, const Slab& b) {
      double worst = 0;
      for (std::size_t i = 0; i < a.values.size(); ++i)
        worst = std::max(worst, std::abs(static_cast<double>(a.values[i]) - static_cast<double>(b.values[i])));
      return worst;
    };
    const Slab object = first_lane(parts::noise(light.object(), 3));
    Slab rays(light.sinogram().width, light.sinogram().height);
    Slab copied = parts::noise(light.sinogram(), 4);
    light.forward({&object, 1}, {&rays, 1});
    quicker->forward({&object, 1}, {&copied, 1});
    CHECK(difference(rays, copied) < 1e-4);
    const Slab g = first_lane(parts::noise(light.sinogram(), 5));
    Slab dose(size, size);
    Slab dose_of_copies = parts::noise(light.object(), 6);
    light.adjoint({&g, 1}, {&dose, 1});
    quicker->adjoint({&g, 1}, {&dose_of_copies, 1});
    CHECK(difference(dose, dose_of_copies) < 1e-4);
  }
  CHECK(ParallelOperator(parts::turn(64, 90)).for_one_slice() == nullptr);
  auto beside = parts::turn(64, 96);
  beside.axis_x += 0.25;
  CHECK(ParallelOperator(beside).for_one_slice() == nullptr);
  auto later = parts::turn(64, 96);
  later.angle_start_rad = 0.01;
  CHECK(ParallelOperator(later).for_one_slice() == nullptr);
  CHECK(ParallelOperator(parts::turn(64, 96).with_alpha(-0.01)).for_one_slice() == nullptr);
  auto oblong = parts::turn(64, 96);
  oblong.ny = 66;
  oblong.axis_y += 1;
  CHECK(ParallelOperator(oblong).for_one_slice() == nullptr);
}

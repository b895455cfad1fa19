#include <doctest/doctest.h>

#include <cmath>

#include "oracle/part_2d.hpp"
#include "parts.hpp"

using namespace vam::optimize;
using parts::dot;

namespace {

/// |<A f, g> - <f, A* g>| / (|A f| |g|)
}  // namespace

TEST_CASE("A and A* are adjoint, with half the rows and with all") {
  CHECK(parts::adjoint_error(ParallelOperator(parts::turn(64, 90))) < 1e-5);
  CHECK(parts::adjoint_error(ParallelOperator(parts::turn(65, 91))) < 1e-5);
}

TEST_CASE("the filters are symmetric, and the preconditioner is positive") {
  const ParallelOperator light(parts::turn(64, 90));
  CHECK(parts::asymmetry_of_preconditioner(light) < 1e-5);
  const Slab a = parts::noise(light.sinogram(), 3);
  Slab filtered = a;
  light.precondition({&filtered, 1});
  CHECK(dot(a, filtered) > 0);
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
  const int size = 128;
  const ParallelOperator light(parts::turn(size, 360));
  const auto disc = oracle::draw(size, [](double x, double y) { return std::hypot(x - 10, y + 5) < 30; });
  Slab f(size, size);
  vam::tomo::pack(disc.data(), 1, f);
  std::vector<Slab> g;
  filtered_projections(light, {&f, 1}, g);
  Slab dose(size, size);
  light.adjoint(g, {&dose, 1});
  const float inside = *dose.at(73, 58);  // the disc's centre
  const float outside = *dose.at(30, 100);
  CHECK(inside == doctest::Approx(1.0).epsilon(0.005));  // [KS88]: the band-limited ramp keeps the mean
  CHECK(std::abs(outside) < 0.01);
}

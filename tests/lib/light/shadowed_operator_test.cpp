// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/operators/private/shadowed_operator.hpp"

#include "lib/light/operator_checks.hpp"
#include "lib/optimize/parts.hpp"
#include "light/operators/private/attenuated_operator.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/target/exclusions.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;
using parts::dot;
using parts::packed;

namespace {

/// A cross: concave, so that light may pass one arm and meet the next.
std::vector<float> cross(int size) {
  return vam::oracle::draw(size, [=](double x, double y) {
    return (std::abs(x) < 0.2 * size && std::abs(y) < 3) || (std::abs(y) < 0.2 * size && std::abs(x) < 3);
  });
}

}  // namespace

TEST_CASE("A and A* are adjoint around an insert, with and without absorption") {
  const int size = 64;
  const Slab insert = packed(cross(size), size);
  for (const double mu : {0.0, 1.0 / 32}) {
    const ShadowedOperator light(parts::turn(size, 90), mu, 32, {&insert, 1});
    CHECK(parts::adjoint_error(light) < 1e-5);
  }
}

TEST_CASE("without an insert it is the attenuated pair, which is another implementation") {
  const int size = 48;
  const Slab nothing(size, size);
  const auto turn = parts::turn(size, 60);
  const ShadowedOperator shadowed(turn, 0.02, 24, {&nothing, 1});
  const AttenuatedOperator plain(turn, 0.02, 24);
  Slab g = parts::noise(plain.sinogram(), 3);
  const Slab a = parts::dose_of(shadowed, g);
  const Slab b = parts::dose_of(plain, g);
  for (const auto [y, x] : indices(size, size)) {
    if (std::hypot(x - 23.5, y - 23.5) < 22)
      CHECK(static_cast<double>(std::abs(*a.at(x, y) - *b.at(x, y))) <
            1e-2);  // of sums of order 5; e^{-mu s} is taken at the column here and at the voxel there
  }
}

TEST_CASE("a beam ends where it meets the insert, and only in slices that have one") {
  const int size = 65;
  Slab insert(size, size);
  *insert.at(40, 30) = 1;  // lane 0 only
  const ShadowedOperator light(parts::turn(size, 4), 0, 32, {&insert, 1});
  Slab g(size, 4);
  std::fill_n(g.at(40, 0), 16, 1.0F);  // angle 0: along +y
  const Slab dose = parts::dose_of(light, g);
  CHECK(dose.at(40, 29)[0] == doctest::Approx(1.0));
  CHECK(dose.at(40, 30)[0] == 0.0F);
  CHECK(dose.at(40, 50)[0] == 0.0F);
  CHECK(dose.at(40, 50)[1] == doctest::Approx(1.0));
  CHECK(dose.at(39, 50)[0] == 0.0F);  // no light there at all
}

TEST_CASE("a closed ring leaves its inside dark") {
  const int size = 64;
  const Slab ring =
      packed(vam::oracle::draw(size, [](double x, double y) { return std::abs(std::hypot(x, y) - 12) < 2; }), size);
  const ShadowedOperator light(parts::turn(size, 90), 0, 32, {&ring, 1});
  Slab g(size, 90);
  std::fill(g.values.begin(), g.values.end(), 1.0F);
  const Slab dose = parts::dose_of(light, g);
  CHECK(*dose.at(32, 32) == 0.0F);
  CHECK(*dose.at(60, 32) > 0.0F);
}

TEST_CASE("a handle around a screwdriver's shaft: at least 98 % of the voxels are correct") {
  const int size = 128;
  const auto shaft = vam::oracle::draw(size, [](double x, double y) { return std::hypot(x, y) < 12; });
  auto handle = vam::oracle::draw(size, [](double x, double y) {
    const double r = std::hypot(x, y);
    return r < 34 + 4 * std::cos(6 * std::atan2(y, x)) && r >= 12;
  });
  const Slab insert = packed(shaft, size);
  const ShadowedOperator light(parts::turn(size, 120), 0, 64, {&insert, 1});
  auto problem = parts::make_problem(handle.data(), 1, size, size, parts::circle(size), {});
  exclude(problem, {&insert, 1});
  CHECK(exclude_dark(problem, light) ==
        std::vector<std::int64_t>(lanes, 0));  // round a convex insert everything can be lit from half the angles
  Iterate state;
  run_method(*make_method("apg", {}), problem, light, {.iterations = 20, .until = {}, .patience = 0}, state);
  const auto m = metrics(state.dose, problem)[0];
  vam::model::DoseStatistics at(m.iou_threshold);
  for (std::size_t i = 0; i < problem.labels[0].size(); i += lanes)
    at.add(state.dose[0].values[i], problem.labels[0][i]);
  MESSAGE("PW " << m.pw << ", IoU " << m.iou << ", wrong " << at.at_threshold()->wrong);
  CHECK(at.at_threshold()->wrong <= 0.02);
}

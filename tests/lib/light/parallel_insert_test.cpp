// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel light around an opaque insert.
#include "base/constants.hpp"
#include "lib/light/operator_checks.hpp"
#include "lib/optimize/parts.hpp"
#include "light/operators/make_operator.hpp"
#include "optimize/methods/metrics.hpp"
#include "optimize/target/exclusions.hpp"
#include "oracle/part_2d.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::optimize;
using namespace vam::light;

namespace {

/// In units of the dose of an angle of the turn.
Slab dose_of_image(const Operator& light, Slab image) {
  for (float& value : image.values) value *= static_cast<float>(light.image().height / turn_rad);
  Slab g(light.sinogram().width, light.sinogram().height);
  light.collapse(image, g);
  return parts::dose_of(light, g);
}

}  // namespace

TEST_CASE("around nothing it is the plain pair, which is another implementation") {
  const int size = 48;
  const Slab nothing(size, size);
  for (const double mu : {0.0, 0.02}) {
    const ParallelBeam beam{parts::turn(size, 60), mu, 24};
    const auto around = make_operator(beam, {&nothing, 1}), plain = make_operator(beam);
    const Slab image = parts::noise(plain->image(), 3);
    const Slab a = dose_of_image(*around, image), b = dose_of_image(*plain, image);
    double apart = 0, all = 0;
    for (const auto [y, x] : indices(size, size)) {
      if (std::hypot(x - 23.5, y - 23.5) >= 22) continue;
      apart += std::pow(*a.at(x, y) - *b.at(x, y), 2);
      all += std::pow(*b.at(x, y), 2);
    }
    CHECK(apart < (1e-6 + std::pow(0.5 * mu, 2)) * all);  // a table of rays; e^{-mu s} within half a voxel
  }
}

TEST_CASE("A and A* are adjoint around a closed ring, whose inside is dark") {
  const int size = 64;
  const auto ring = vam::oracle::draw(size, [](double x, double y) { return std::abs(std::hypot(x, y) - 12) < 2; });
  const Slab insert = parts::packed(ring, size);
  for (const double mu : {0.0, 1.0 / 32}) {
    const auto light = make_operator(ParallelBeam{parts::turn(size, 90), mu, 32}, {&insert, 1});
    CHECK(parts::adjoint_error(*light) < 1e-5);
    const Slab dose = parts::dose_of(*light, parts::noise(light->sinogram(), 3));
    CHECK(*dose.at(32, 32) == 0.0F);
    CHECK(*dose.at(60, 32) != 0.0F);
  }
}

TEST_CASE("a beam ends where it meets the insert, and only in slices that have one") {
  const int size = 65;
  Slab insert(size, size);
  *insert.at(40, 30) = 1;  // lane 0 only
  const auto light = make_operator(ParallelBeam{parts::turn(size, 4), 0, 32}, {&insert, 1});
  Slab g(size, 4);
  std::fill_n(g.at(40, 0), 16, 1.0F);  // angle 0: along +y
  const Slab dose = dose_of_image(*light, g);
  CHECK(dose.at(40, 29)[0] == doctest::Approx(1.0));
  CHECK(dose.at(40, 30)[0] == 0.0F);
  CHECK(dose.at(40, 50)[0] == 0.0F);
  CHECK(dose.at(40, 50)[1] == doctest::Approx(1.0));
  CHECK(dose.at(39, 50)[0] == 0.0F);  // no light there at all
}

TEST_CASE("a handle around a screwdriver's shaft: at least 98 % of the voxels are correct") {
  const int size = 128;
  const auto shaft = vam::oracle::draw(size, [](double x, double y) { return std::hypot(x, y) < 12; });
  auto handle = vam::oracle::draw(size, [](double x, double y) {
    const double r = std::hypot(x, y);
    return r < 34 + 4 * std::cos(6 * std::atan2(y, x)) && r >= 12;
  });
  const Slab insert = parts::packed(shaft, size);
  const auto light = make_operator(ParallelBeam{parts::turn(size, 120), 0, 64}, {&insert, 1});
  auto problem = parts::make_problem(handle.data(), 1, size, size, parts::circle(size), {});
  exclude(problem, {&insert, 1});
  CHECK(exclude_dark(problem, *light) ==
        std::vector<std::int64_t>(lanes, 0));  // round a convex insert everything can be lit from half the angles
  Iterate state;
  run_method(*make_method("apg", {}), problem, *light, {.iterations = 20, .until = {}, .patience = 0}, state);
  const auto m = metrics(state.dose, problem)[0];
  vam::model::DoseStatistics at(m.iou_threshold);
  for (std::size_t i = 0; i < problem.labels[0].size(); i += lanes)
    at.add(state.dose[0].values[i], problem.labels[0][i]);
  MESSAGE("PW " << m.pw << ", IoU " << m.iou << ", wrong " << at.at_threshold()->wrong);
  CHECK(at.at_threshold()->wrong <= 0.02);
}

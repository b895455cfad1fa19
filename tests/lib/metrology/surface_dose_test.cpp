// SPDX-License-Identifier: GPL-3.0-or-later
// The dose on the surface of a ball in a dose that falls off from its centre.
#include "metrology/compare/surface_dose.hpp"

#include "solid/voxel/isosurface.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::metrology;

namespace {

/// value(distance from the centre), heights times stretch_z.
template <class Function>
model::Volume around(double stretch_z, Function value) {
  model::Volume volume{model::centred_grid(61, 61, 61, 0.1, -3), {}};
  const model::Grid& g = volume.grid;
  for (const auto [k, j, i] : indices(g.nz, g.ny, g.nx)) {
    const double distance = std::hypot(g.x_mm(i), g.y_mm(j), g.z_mm(k) / stretch_z);
    volume.values.push_back(static_cast<float>(value(distance)));
  }
  return volume;
}

model::TriangleSoup ball(double radius_mm) {
  return solid::isosurface(around(1, [&](double distance) { return radius_mm - distance + 1; }), 1);
}

double fall(double distance_mm) { return 100 - 20 * distance_mm; }

}  // namespace

TEST_CASE("Surface dose: it and its slope are those of the radius, also in a stretched dose") {
  for (const double stretch_z : {1.0, 1.1}) {
    const auto found = surface_dose(ball(1.9), around(stretch_z, fall), stretch_z, "ball.ply");
    // The facets of the isosurface lie up to 0.1^2 / (8 x 1.9) mm inside the ball: 0.02 mJ/cm3.
    CHECK(found.critical_dose_mj_cm3.value == doctest::Approx(62).epsilon(0.0005));
    CHECK(found.critical_dose_mj_cm3.sigma < 0.02);
    CHECK(found.spread_mj_cm3 < 0.05);
    CHECK(found.gradient_mj_cm3_mm == doctest::Approx(20).epsilon(0.01));
  }
}

TEST_CASE("Surface dose: what differs between sides is in the standard deviation") {
  auto dose = around(1, fall);
  const model::Grid& g = dose.grid;
  for (std::size_t n = 0; n < g.size(); ++n) {
    if (n / g.slice_size() > 30) dose.values[n] += 8;
  }
  const auto found = surface_dose(ball(1.9), dose, 1, "ball.ply");
  CHECK(found.critical_dose_mj_cm3.sigma > 1);
  CHECK(found.critical_dose_mj_cm3.sigma < 4);
}

TEST_CASE("Surface dose: a print beyond the dose, or without a surface, is refused") {
  auto aside = ball(1.9);
  for (auto& point : aside.points) point[0] += 2;
  CHECK(fault_of([&] { (void)surface_dose(aside, around(1, fall), 1, "ball.ply"); }) == Fault::data);
  CHECK(fault_of([&] { (void)surface_dose({}, around(1, fall), 1, "ball.ply"); }) == Fault::data);
}

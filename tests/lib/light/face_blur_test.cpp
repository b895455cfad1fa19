// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/blurred_faces.hpp"
#include "model/magnification.hpp"
#include "optics/skew_ray.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::light;

TEST_CASE("a face is smeared by what a ray climbs across it") {
  const model::Printer printer;
  FlatFace face{6.0, true, 10, 50};
  const double climb = optics::skew_ray(optics::projector_view(printer), 0, 6).climb;
  CHECK(climb == doctest::Approx(6 / (119.808 * 1.53)).epsilon(1e-2));  // z_p / (D n), to first order [physics §11]
  CHECK(blur_voxels(printer, face, 0.1) == doctest::Approx(climb * 100 / model::vertical_magnification(printer)));
  face.z_mm = -6;
  CHECK(blur_voxels(printer, face, 0.1) > 0);
  face.z_mm = 0;
  CHECK(blur_voxels(printer, face, 0.1) == doctest::Approx(0));
  model::Printer level;
  level.projector.telecentric = true;
  face.z_mm = 6;
  CHECK(blur_voxels(level, face, 0.1) == 0);
}

TEST_CASE("the best height has the widest face level with the lens") {
  const model::Printer printer;
  const std::vector<FlatFace> one{{3, true, 10, 80}};
  CHECK(best_lift_mm(printer, one, 0.1, -10, 10) == doctest::Approx(-3));
  CHECK(best_lift_mm(printer, one, 0.1, -2.03, 10) == doctest::Approx(-2));  // as the image allows, in whole voxels
  const std::vector<FlatFace> two{{3, true, 10, 80}, {-5, false, 10, 80}};
  CHECK(best_lift_mm(printer, two, 0.1, -10, 10) == doctest::Approx(1).epsilon(0.2));
  CHECK(best_lift_mm(printer, {}, 0.1, -10, 10) == 0);
  CHECK(best_lift_mm(printer, {}, 0.1, 4, 10) == doctest::Approx(4));
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/blurred_faces.hpp"

#include "model/magnification.hpp"
#include "optics/skew_ray.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::light;

TEST_CASE("faces are hard where rays smear them and voxels nearby are wrong") {
  const model::Printer printer;
  const model::Grid grid = model::centred_grid(40, 40, 100, 0.1, -4.95);  // z = -5 ... 5
  const std::vector<FlatFace> faces{{0, false, 10, 80}, {4, true, 1, 1}, {4.5, true, 12, 113}};
  std::vector<std::int64_t> wrong(100, 0);
  CHECK(blurred_faces(printer, grid, wrong, faces).empty());
  wrong[48] = 7;  // beside the face that is level with the lens: rays do not smear that one
  CHECK(blurred_faces(printer, grid, wrong, faces).empty());
  wrong[96] = 5;
  wrong[92] = 3;
  wrong[91] = wrong[98] = 1;  // beyond
  const auto hard = blurred_faces(printer, grid, wrong, faces);
  REQUIRE(hard.size() == 1);  // the narrow one is smeared by less than a voxel
  CHECK(hard[0].face.z_mm == 4.5);
  CHECK(hard[0].blur_voxels == doctest::Approx(blur_voxels(printer, faces[2], 0.1)));
  CHECK(hard[0].wrong_voxels == 8);  // smeared over three voxels up and down: slices 92 ... 97
}

TEST_CASE("the remedy moves the worst face to the height of the lens, or tilts it by the climb of the rays") {
  const model::Printer printer;
  const std::vector<FlatFace> faces{{9, true, 12, 113}};
  const std::vector<BlurredFace> hard{{faces[0], blur_voxels(printer, faces[0], 0.1), 5}};
  const FaceRemedy free = face_remedy(printer, faces, hard, 0.1, -20, 20);
  CHECK(free.lift_mm == doctest::Approx(-9));
  CHECK(free.blur_voxels < 0.1);
  const FaceRemedy bound = face_remedy(printer, faces, hard, 0.1, -3, 20);
  CHECK(bound.lift_mm == doctest::Approx(-3));
  CHECK(bound.blur_voxels == doctest::Approx(hard[0].blur_voxels * 2 / 3).epsilon(0.02));
  CHECK(free.tilt_deg == std::ceil(std::atan(hard[0].blur_voxels * 0.1 / 12) * 180 / M_PI));
}

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

// SPDX-License-Identifier: GPL-3.0-or-later
// Statistical refinement of slices.
#include "metrology/ost/private/mlem.hpp"

#include "testing.hpp"

using namespace vam;

TEST_CASE("the likelihood's maximum of exact sinograms is the image, and pixels that no ray meets stay empty") {
  tomo::ParallelGeometry geometry;
  geometry.nx = geometry.ny = 32;
  geometry.columns = 20;  // the corners are beyond all rays
  geometry.angles = 40;
  geometry.axis_x = geometry.axis_y = 15.5;
  geometry.angle_step_rad = 2 * std::numbers::pi / geometry.angles;
  std::vector<Slab> disc(1, Slab(32, 32));
  for (const auto [y, x] : indices(32, 32)) *disc[0].at(x, y) = std::hypot(x - 15.5, y - 15.5) < 6 ? 1.0F : 0.0F;
  std::vector<Slab> sinograms(1, Slab(geometry.columns, geometry.angles));
  tomo::forward(geometry, disc, sinograms);
  std::vector<Slab> images(1, Slab(32, 32));
  std::fill(images[0].values.begin(), images[0].values.end(), 0.5F);
  metrology::maximise_likelihood(geometry, sinograms, 60, images);
  CHECK(*images[0].at(0, 0) < 1e-6F);
  CHECK(*images[0].at(31, 31) < 1e-6F);
  CHECK(*images[0].at(15, 15) == doctest::Approx(1).epsilon(0.03));
  CHECK(*images[0].at(15, 24) < 0.05F);
  CHECK(std::all_of(images[0].values.begin(), images[0].values.end(), [](float v) { return v >= 0; }));
}

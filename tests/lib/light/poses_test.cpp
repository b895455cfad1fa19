// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/poses.hpp"

#include "light/grids/dose_grid.hpp"
#include "light/grids/lit_grid.hpp"
#include "light/rays/vial_setup.hpp"
#include "model/magnification.hpp"
#include "optics/writable_radius.hpp"
#include "testing.hpp"

using namespace vam;
using namespace vam::light;

namespace {

/// 40 rows of 0.1 mm before a vial.
model::Printer low_picture() {
  return {.projector = {.columns = 240,
                        .rows = 40,
                        .pixel_mm = 0.1,
                        .lens_distance_mm = 120,
                        .axis_column = 119.5,
                        .axis_row = 19.5},
          .stage = {.motion = "stepped"}};
}

}  // namespace

TEST_CASE("a wobbling vial stays in its place in the turning frame") {
  for (const int direction : {1, -1}) {
    const model::Poses poses = wobble_poses(0.3, 40, direction, 90);
    for (const model::Pose& pose : poses) {
      const double theta = direction * pose.angle_deg * M_PI / 180;  // the frame turns by -theta
      CHECK(pose.dx_mm * std::cos(theta) - pose.dy_mm * std::sin(theta) ==
            doctest::Approx(0.3 * std::cos(40 * M_PI / 180)));
      CHECK(pose.moves == model::Moves::vial);
    }
    CHECK(model::repeat(poses));
  }
}

TEST_CASE("a helix passes the whole part through the whole image") {
  const model::Printer printer = low_picture();
  const double scale = model::vertical_magnification(printer);
  const model::Grid part = model::centred_grid(10, 10, 120, 0.1, 3.05);
  for (const double pitch : {16 * scale / 3, -16 * scale / 3, 3.0}) {
    const model::Poses poses = helix_poses(printer, part, pitch, 60);
    const double turns = static_cast<double>(poses.size()) / 60;
    CHECK(turns == std::ceil(16 * scale / std::abs(pitch) - 1e-6));
    const model::LiftRange lift = model::lift_mm(poses);
    CHECK((lift.most - lift.least) / (turns * 60 - 1) * 60 == doctest::Approx(std::abs(pitch)));
    // Halfway the part's middle is in the image's.
    CHECK(0.5 * (lift.least + lift.most) == doctest::Approx(-scale * part.z_mm(59.5)));
    CHECK_FALSE(model::repeat(poses));
  }
  CHECK(fault_of([&] { static_cast<void>(helix_poses(printer, part, 8 * scale + 0.01, 60)); }) == Fault::usage);
  CHECK_NOTHROW(static_cast<void>(helix_poses(printer, part, 8 * scale - 0.01, 60)));
  CHECK(fault_of([&] { static_cast<void>(helix_poses(printer, part, 1e-9, 60)); }) == Fault::usage);
  CHECK(fault_of([&] { static_cast<void>(helix_poses(printer, part, 1e-4, 60)); }) == Fault::usage);
}

TEST_CASE("rows are those of the image, or as many as light the part in any pose") {
  const model::Printer printer = low_picture();
  const double scale = model::vertical_magnification(printer);
  const model::Grid tall = model::centred_grid(10, 10, 120, 0.1, -5.95);
  VialSetup setup = vial_setup(printer, tall, 60, 0);
  place_rows(setup, helix_poses(printer, tall, 5, 60), tall);
  CHECK(setup.rows == 40);
  CHECK(setup.first_row_mm == doctest::Approx(-1.95));
  CHECK(setup.turn.rows == static_cast<int>(setup.poses.size()));

  const model::Grid low = model::centred_grid(10, 10, 10, 0.1, -0.45);
  setup = vial_setup(printer, low, 2, 0);
  place_rows(setup, {{0, 0, 0, 0, model::Moves::part}, {180, 0, 0, -scale, model::Moves::part}}, low);
  CHECK(setup.rows == 20);
  CHECK(setup.first_row_mm == doctest::Approx(-1.45));
  const model::Poses away{{0, 0, 0, 9, model::Moves::part}};
  CHECK(fault_of([&] { place_rows(setup, away, low); }) == Fault::data);
}

TEST_CASE("around a lifted part as much is judged as rows light") {
  const model::Printer printer = low_picture();
  const double radius = optics::writable_radius_mm(printer);
  const model::Grid low = model::centred_grid(100, 100, 10, 0.1, -0.45);
  const Margin still = lit_margin(printer, low, radius);
  const Margin sinking =
      lit_margin(printer, low, radius, {{0, 0, 0, 0, model::Moves::part}, {180, 0, 0, -1.3, model::Moves::part}});
  CHECK(sinking.below > still.below);
  CHECK(sinking.above >= still.above);
  model::StackInfo info;
  info.space = model::Space::projector;
  info.count = 40;
  info.pixel_mm = info.row_mm = 0.1;
  info.z_start_mm = -1.95;
  info.poses = {{0, 0, 0, 3, model::Moves::vial}, {180, 0, 0, -4, model::Moves::vial}};
  const model::Grid seen = dose_grid(printer, info, 5.0);
  CHECK(seen.z_mm(0) <= -1.95 - 3);
  CHECK(seen.z_mm(seen.nz - 1) >= 1.95 + 4);
}

TEST_CASE("a displaced vial and a part beyond the writable radius are too much") {
  const model::Printer printer;
  const double radius = optics::writable_radius_mm(printer);
  const model::Poses poses = wobble_poses(0.3, 0, 1, 4);
  CHECK_NOTHROW(require_in_reach(poses, printer, radius));
  CHECK_NOTHROW(require_in_reach({}, printer, 12.7));
  CHECK(fault_of([&] { require_in_reach(poses, printer, 12.7); }) == Fault::data);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/pose.hpp"

#include <stdexcept>

#include "testing.hpp"

using namespace vam::model;

namespace {

const Poses sinking{{0, 0, 0, 0, Moves::part}, {90, 0.1, -0.25, -1.5, Moves::part}, {180, 0.2, 0, -3, Moves::part}};

}  // namespace

TEST_CASE("a table of poses survives as text, and other texts are refused") {
  CHECK(parse_poses(poses_text(sinking)) == sinking);
  CHECK(poses_text({}) == "angle_deg,dx_mm,dy_mm,dz_mm,moves");
  for (const char* wrong :
       {"", "angle", "angle_deg,dx_mm,dy_mm,dz_mm,moves\n0,0,0,vial", "angle_deg,dx_mm,dy_mm,dz_mm,moves\n0,0,0,x,vial",
        "angle_deg,dx_mm,dy_mm,dz_mm,moves\n0,0,0,0,lens"}) {
    CHECK_THROWS_AS(static_cast<void>(parse_poses(wrong)), std::runtime_error);
  }
}

TEST_CASE("extent of poses, and whether they can be repeated") {
  CHECK(lift_mm(sinking).least == -3);
  CHECK(lift_mm(sinking).most == 0);
  CHECK(farthest_mm(sinking, Moves::part) == doctest::Approx(0.269258));
  CHECK(farthest_mm(sinking, Moves::vial) == 0);
  CHECK(repeat({}));
  CHECK(repeat({{0, 1, 0, 0, Moves::vial}, {120, 0, 1, 0, Moves::vial}, {240, -1, 0, 0, Moves::vial}}));
  Poses helix;
  for (int k = 0; k < 10; ++k) helix.push_back({36.0 * k, 0, 0, 0.5 * k, Moves::vial});
  CHECK_FALSE(repeat(helix));
}

TEST_CASE("between two poses, and beyond the ends") {
  CHECK(pose_between(sinking, 0.5).dz_mm == -0.75);
  CHECK(pose_between(sinking, 0.5).angle_deg == 45);
  Poses helix;
  for (int k = 0; k < 10; ++k) helix.push_back({36.0 * k, 0, 0, 0.5 * k, Moves::vial});
  CHECK(pose_between(helix, -2) == helix.front());
  CHECK(pose_between(helix, 99).dz_mm == helix.back().dz_mm);
  const Poses wobble{{0, 1, 0, 0, Moves::vial}, {120, 0, 1, 0, Moves::vial}, {240, -1, 0, 0, Moves::vial}};
  CHECK(pose_between(wobble, 2.5) == Pose{300, 0, 0, 0, Moves::vial});  // half way back to the first one
  CHECK(pose_between(wobble, 3.5).dx_mm == 0.5);
  CHECK(pose_between(wobble, -1).dx_mm == -1);
}

TEST_CASE("poses repeat where the last is at most two steps from the first, in any direction") {
  for (double Pose::*along : {&Pose::dx_mm, &Pose::dy_mm, &Pose::dz_mm}) {
    const auto repeats = [&](double last_mm) {
      Poses poses(4);
      const double mm[] = {5, 6, 7, last_mm};  // steps of 1 mm
      for (std::size_t k = 0; k < 4; ++k) poses[k].*along = mm[k];
      return repeat(poses);
    };
    CHECK(repeats(7));
    CHECK_FALSE(repeats(7.01));
    CHECK_FALSE(repeats(7.9));
  }
}

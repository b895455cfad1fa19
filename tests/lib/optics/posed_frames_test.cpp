// SPDX-License-Identifier: GPL-3.0-or-later
#include "optics/projector_frames.hpp"
#include "testing.hpp"

using namespace vam::optics;
using vam::model::StackInfo;

namespace {

/// One slice, eight angles of two turns.
StackInfo two_turns() {
  StackInfo info;
  info.space = vam::model::Space::projector;
  info.width = 12;
  info.height = 8;
  info.count = 1;
  info.pixel_mm = info.row_mm = 0.1;
  info.angle_step_deg = 90;
  return info;
}

/// The value tells angle and column.
FrameComposer composed(const StackInfo& info, const FramePlace& place) {
  vam::Image image(info.width, info.height);
  for (int a = 0; a < info.height; ++a) {
    for (int c = 2; c < info.width - 2; ++c) image(c, a) = static_cast<float>(1 + c + 100 * a);
  }
  FrameComposer composer("part.exr", info, place);
  composer.add(image, 0);
  composer.check();
  return composer;
}

}  // namespace

TEST_CASE("a stack with poses is shown for the turns that it has, and does not wrap unless it can be repeated") {
  StackInfo info = two_turns();
  FramePlace place{.columns = 12, .rows = 1, .pixel_mm = 0.1};
  CHECK(fault_of([&] { FrameComposer("part.exr", info, place); }) == vam::Fault::data);  // two turns
  for (int k = 0; k < 8; ++k) info.poses.push_back({90.0 * k, 0, 0, 0.1 * k, vam::model::Moves::vial});
  const FrameComposer helix = composed(info, place);
  CHECK(helix.frame(450, 90)(5, 0) == 506);  // the fifth of all, in the second turn
  CHECK(helix.frame(675, 45)(5, 0) == 706);  // past the last one: not the first
  CHECK(turns_of(info) == 2);
  CHECK(turns_to_show(info, {}, 5) == 2);
  CHECK(turns_to_show(info, 2.0, 5) == 2);
  CHECK(fault_of([&] { static_cast<void>(turns_to_show(info, 4.0, 5)); }) == vam::Fault::usage);
  const StackInfo frames = frames_info(info, place, frame_schedule(8, 360, 2), "normal");
  REQUIRE(frames.poses.size() == 16);
  CHECK(frames.poses[3].dz_mm == doctest::Approx(0.15));
  CHECK(frames.poses[3].angle_deg == 135);

  for (vam::model::Pose& pose : info.poses) pose.dz_mm = 0;
  CHECK(composed(info, place).frame(675, 45)(5, 0) == doctest::Approx(0.5 * (706 + 6)));
  CHECK(turns_to_show(info, 4.0, 5) == 4);
  info.poses.clear();
  CHECK(turns_to_show(info, {}, 5) == 5);
}

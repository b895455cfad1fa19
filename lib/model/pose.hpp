// SPDX-License-Identifier: GPL-3.0-or-later
// Where the vial, or the part in it, stands while each frame is shown: off the place that the settings give it.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace vam::model {

/// What a displacement moves: the vial with all that is in it (wobble; refraction moves with it), or the part in a vial
/// that stays (sinking). Along z both are the same, as the vial is a cylinder.
enum class Moves { vial, part };

/// The displacement in the laboratory while one frame is shown: x along the projector's columns, y along the light, z
/// up, in mm [physics §1].
struct Pose {
  double angle_deg = 0;  // stage angle of the frame
  double dx_mm = 0;
  double dy_mm = 0;
  double dz_mm = 0;
  Moves moves = Moves::vial;
  bool operator==(const Pose&) const = default;
};

/// One for every frame, in order; none: nothing is displaced.
using Poses = std::vector<Pose>;

/// Why the poses are not those of frames at start_deg, start_deg + step_deg ...; empty where they are.
[[nodiscard]] std::string objection(const Poses& poses, double start_deg, double step_deg);

/// From the cells angle_deg, dx_mm, dy_mm, dz_mm, moves ("vial" or "part"). Throws std::runtime_error for others, and
/// for a pose that is none of this world.
[[nodiscard]] Pose pose_of(std::span<const std::string> cells);

/// The lines of a table of poses with its header, "angle_deg,dx_mm,dy_mm,dz_mm,moves" [formats: Poses], and the way
/// back. Throws std::runtime_error for another text and what pose_of() throws.
[[nodiscard]] std::string poses_text(const Poses& poses);
[[nodiscard]] Poses parse_poses(const std::string& text);

struct LiftRange {
  double least = 0;
  double most = 0;
};
/// Of dz_mm; 0 without poses.
[[nodiscard]] LiftRange lift_mm(const Poses& poses);

/// Largest horizontal displacement of the vial, or of the part in the vial.
[[nodiscard]] double farthest_mm(const Poses& poses, Moves moves);

/// Whether the frames can be shown again and again: the way from the last pose back to the first one is no longer than
/// twice the longest way from frame to frame.
[[nodiscard]] bool repeat(const Poses& poses);

/// At a place between frames, linear between the nearest two; beyond the ends, poses that repeat() go on from the other
/// end, others stay. `moves` is that of the nearest. Angles are even.
[[nodiscard]] Pose pose_between(const Poses& poses, double frame);

}  // namespace vam::model

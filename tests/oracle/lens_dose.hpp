// SPDX-License-Identifier: GPL-3.0-or-later
// The dose of light that has width, ray by ray: each point of a lens's pupil sends its own rays by vector Snell's law
// through window, wall and resin, and each frame is shown at several stage angles. Backwards, from a point of the resin
// to the pixels that light it, and forwards, from the pixels through voxels. Frames and signs are those of [physics
// §1].
#pragma once

#include <functional>
#include <vector>

namespace vam::oracle {

/// A point of the pupil, by the tangents of the angles at which its rays meet the chief rays in the image plane in air.
struct PupilPoint {
  double x = 0, z = 0;
  double weight = 1;
};

/// A stage angle at which a frame is shown, relative to the frame's own, and its share of the frame's time.
struct HoldAngle {
  double angle = 0;
  double weight = 1;
};

struct LensBench {
  double radius = 0, wall = 0;             // outer radius of the vial, thickness of its wall: 0 for none
  double air = 1, bath = 1;                // indices at the lens, and around the vial
  double glass = 1.5, resin = 1.5;         // indices
  double window = 0;                       // distance of a flat window of the bath before the axis
  double column_throw = 0, row_throw = 0;  // distance of the lens from the axis, across and along z: 0 telecentric
  double focus = 0;                        // of the image, behind the axis, in air
  double pixel = 0;                        // edge of the pixels, which are even squares, by chief rays in y = 0
  double absorption = 0;                   // per length
  std::vector<PupilPoint> pupil = {{}};    // weights add up to 1
  std::vector<HoldAngle> hold = {{}};      // weights add up to 1
  int frames = 0;                          // over one turn, the first at 0
};

struct LensPoint {
  double x = 0, y = 0, z = 0;  // from the axis in the frame of the part
};

/// Power per area of the image in y = 0: (frame, row, column); the corner of column 0 and row 0 is on the optical axis.
using Frames = std::function<double(int, int, int)>;

/// 4 rings^2 points of even weight: the mean and the mean square of either tangent are exactly those of the disc.
std::vector<PupilPoint> round_pupil(double half_angle, int rings);
/// A frame shown while the stage turns by `width`: in the middles of `count` equal parts, around the frame's angle.
std::vector<HoldAngle> held(double width, int count);
/// What a round aperture is in the plane: the weights of its chords sqrt(half_angle^2 - a^2) as a hold.
std::vector<HoldAngle> chords(double half_angle, int count);

/// Light in the resin, from where it enters it, in the laboratory.
struct ResinRay {
  LensPoint at, along;     // place, unit direction
  double transmitted = 1;  // Fresnel's, over all interfaces; 0 without a way into the resin
};

/// The ray from a point of the pupil through the place (x, z) of the image: in y = 0, by its chief ray.
ResinRay trace_in(const LensBench& bench, double x, double z, const PupilPoint& point);
/// Fluence at a point within the writable radius over one turn, times the angle step of the frames: backwards.
double lens_dose(const LensBench& bench, const Frames& frames, const LensPoint& at);
/// The mean of the same over a cube around `at`, by what rays x rays rays from each pixel of the columns -columns up to
/// columns - 1 (rows alike) leave in it: forwards.
double deposited_lens_dose(const LensBench& bench, const Frames& frames, const LensPoint& at, double edge, int columns,
                           int rows, int rays);

}  // namespace vam::oracle

// SPDX-License-Identifier: GPL-3.0-or-later
#include "light/grids/poses.hpp"

#include <cmath>

#include "base/constants.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "model/magnification.hpp"
#include "model/rows.hpp"
#include "model/tolerances.hpp"
#include "optics/writable_radius.hpp"

namespace vam::light {

model::Poses wobble_poses(double radius_mm, double lab_angle_deg, int direction, int angles) {
  model::Poses poses;
  for (int k = 0; k < angles; ++k) {
    const double angle_deg = 360.0 * k / angles;
    const double at = (lab_angle_deg - direction * angle_deg) * rad_per_deg;
    poses.push_back({angle_deg, radius_mm * std::cos(at), radius_mm * std::sin(at), 0, model::Moves::vial});
  }
  return poses;
}

model::Poses helix_poses(const model::Printer& printer, const model::Grid& grid, double pitch_mm, int angles) {
  const model::Projector& p = printer.projector;
  const double scale = model::vertical_magnification(printer);
  const double image_mm = scale * p.rows * p.pixel_mm;
  const double image_middle_mm = scale * model::z_mm(p, 0.5 * (p.rows - 1));
  const double part_mm = scale * grid.nz * grid.voxel_mm;
  const double part_middle_mm = scale * grid.z_mm(0.5 * (grid.nz - 1));
  const double pitch = std::abs(pitch_mm);
  if (pitch > 2 * image_mm) {
    throw Error{Fault::usage,
                "helix: at " + format_number(pitch, 4) + " mm per turn a slice passes the image, " +
                    format_number(image_mm, 4) + " mm high in the resin, in " + format_number(image_mm / pitch, 3) +
                    " turns; at least half a turn is needed: give at most " + format_number(2 * image_mm, 4)};
  }
  constexpr double rounding = 1e-6;
  const double turns = std::ceil((part_mm + image_mm) / pitch - rounding);
  constexpr double most_frames = 1e6;
  if (!(turns * angles <= most_frames)) {
    throw Error{Fault::usage, "helix: a pitch of " + format_number(pitch) + " mm takes " + format_number(turns, 3) +
                                  " turns; at most " + format_number(std::floor(most_frames / angles)) +
                                  " can be computed: give at least " +
                                  format_number((part_mm + image_mm) * angles / most_frames, 3)};
  }
  const auto frames = round_int(turns * angles);
  model::Poses poses;
  for (int k = 0; k < frames; ++k) {
    const double turned = (k + 0.5) / angles - 0.5 * turns;
    poses.push_back(
        {360.0 * k / angles, 0, 0, image_middle_mm - part_middle_mm + pitch_mm * turned, model::Moves::vial});
  }
  return poses;
}

bool may_move(const model::Printer& printer, double judged_mm, double by_mm) {
  return judged_mm <= optics::writable_radius_mm(printer) + 1e-6 &&
         by_mm <= model::most_displacement_mm(model::resin_radius_mm(printer.vial));
}

void require_in_reach(const model::Poses& poses, const model::Printer& printer, double judged_mm) {
  if (model::farthest_mm(poses, model::Moves::vial) == 0 || may_move(printer, judged_mm, 0)) return;
  throw Error{Fault::data, "poses: the vial is displaced, and the part reaches beyond the writable radius of " +
                               format_number(optics::writable_radius_mm(printer), 4) +
                               " mm; only one of the two is supported"};
}

}  // namespace vam::light

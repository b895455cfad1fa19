// SPDX-License-Identifier: GPL-3.0-or-later
// Optical scattering tomography: camera views of one turn to the scattering density in the vial [OST22 section 2].
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "metrology/ost/axis.hpp"
#include "metrology/ost/cleaning_report.hpp"
#include "metrology/ost/run_out.hpp"
#include "metrology/ost/surface_uncertainty.hpp"
#include "metrology/ost/views.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"

namespace vam::metrology {

struct OstOptions {
  double voxel_mm = 0;             // 0: the binned camera pixel
  std::string window = "cosine";   // of the ramp filter: struts 3 voxels apart keep a contrast of 29 %, with hann 14 %
  bool refraction = true;          // false: columns taken as parallel rays (for comparison)
  bool clean = true;               // take out background, flicker, specks and bubbles
  bool growing = false;            // the print grows during the turn of views: the volume is that of its middle
  bool non_negative = true;        // negative densities become 0
  int mlem_iterations = 0;         // iterations of MLEM [SV82] after FBP, for noisy views
  std::optional<double> axis_row;  // binned row level with the lens, z = 0; the middle one by default
  RunOutVector run_out_mm{};       // of the vial, removed from the views
  double radius_mm = 0;            // of the reconstructed cylinder; 0: all that the camera sees through the vial
};

/// Everything that depends on the rig and not on the data of a turn, made once and used for every turn. Frames are
/// corrected and binned; image rows run downwards, z upwards. Rays are those of [physics §2, §11], exactly; those
/// of a camera that is not telecentric climb [FDK84; physics §8].
class OstReconstructor {
 public:
  /// `pixel_mm` is the pitch of the binned frames at the axis. Throws Fault::data where camera, vial and frames cannot
  /// belong together, and for fewer than four rows or columns.
  OstReconstructor(const model::Printer& printer, double pixel_mm, int columns, int rows, const AxisPose& axis,
                   const OstOptions& options);
  ~OstReconstructor();

  [[nodiscard]] const model::Grid& grid() const;

  /// What the views of a turn say of run-out and axis, from where this rig has them. Not determined where the resin
  /// absorbs more than is given (a line is not the same from its other end) and without refraction; without effect, and
  /// so not seen, in a bath of the resin's index.
  [[nodiscard]] RunOut find_run_out(std::span<const CameraView> views) const;

  /// One volume from the views of one turn, in any order, with their own angles: scattering density in view units per
  /// mm. Frames missing, repeated or uneven are weighted; three turns or more, frames in the order of time, are
  /// combined by their median (Turns). Throws Fault::data when the turn is incomplete. An even background, flicker,
  /// specks and bubbles are taken out; `found` says what.
  [[nodiscard]] model::Volume reconstruct(std::span<const CameraView> views, CleaningReport* found = nullptr) const;

  /// Standard deviation of each voxel of that volume by the noise of the views, their angles counted: the RMS of two
  /// drawn reconstructions of nothing but such noise, over 9 x 9 x 9 voxels of the circle that is seen. Without what
  /// clipping and MLEM make of it.
  [[nodiscard]] VoxelUncertainty uncertainty(std::span<const CameraView> views) const;

 private:
  struct State;
  explicit OstReconstructor(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
// What a stack of images is about: sinograms (one image a slice) or frames (one image an angle or layer).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "model/piece.hpp"
#include "model/pose.hpp"

namespace vam::model {

enum class Kind { sinogram, frames };

/// Whose columns the images have: the ideal parallel-beam ("virtual") projector, the real projector, or the camera.
enum class Space { virtual_, projector, camera };

/// Facts common to all images of a stack (EXR attributes `vam:*`, [formats: Stack attributes]).
/// Sinogram: width = detector columns, axis in the middle (column coordinate (c - (width-1)/2) * pixel_mm),
/// height = stage angles, row a at angle_start_deg + a * angle_step_deg. Frames: width x height of the device.
struct StackInfo {
  Kind kind = Kind::sinogram;
  Space space = Space::virtual_;
  int width = 0;
  int height = 0;
  int count = 0;               // images in the stack
  double pixel_mm = 0;         // column pitch at the rotation axis
  double row_mm = 0;           // pitch of slices (sinogram) or of image rows (frames) along z
  double z_start_mm = 0;       // z of slice 0 (sinogram) or of the centre of row 0 (frames)
  double angle_start_deg = 0;  // stage angle of row 0 (sinogram) or frame 0 (frames)
  double angle_step_deg = 0;
  std::string units = "relative";            // of the pixel values
  std::vector<std::string> history;          // one line per command that touched the data
  std::map<std::string, std::string> extra;  // unknown text attributes, copied through
  Piece piece;                               // of a larger stack; whole: of none
  Poses poses;                               // of the rows of a sinogram or of the frames; none: nothing is displaced
};

/// Facts of one image; absent ones follow from StackInfo and the index.
struct ImageInfo {
  double z_mm = 0;
  double angle_deg = 0;
  double time_s = 0;
  bool has_angle = false;  // frames with a measured angle of their own
  bool has_time = false;
  double time_sigma_s = 0;  // standard deviation that the times of one capture share; 0: not known
  bool has_number = false;  // camera frames
  int number = 0;           // since the camera started; a gap is frames that were lost
  bool incomplete = false;  // parts of the image did not arrive
};

}  // namespace vam::model

// SPDX-License-Identifier: GPL-3.0-or-later
// The frames of a projector sinogram in grey levels, for simulators: what vam-project shows of it.
#pragma once

#include <string>
#include <vector>

#include "base/pixels.hpp"
#include "model/printer.hpp"

namespace vam::session {

struct SinogramFrames {
  std::vector<GreyImage> frames;
  double full_scale = 0;  // that the stack states, or else its largest value
};

/// Of one turn, so many frames; 0: one for each angle. full_scale: instead of the stack's own; 0: none. Of 8 bits, by a
/// linear response. Throws what StackReader and FrameComposer throw.
[[nodiscard]] SinogramFrames sinogram_frames(const std::string& path, const model::Projector& projector, int frames,
                                             double full_scale);

}  // namespace vam::session

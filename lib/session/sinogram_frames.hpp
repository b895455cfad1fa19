// SPDX-License-Identifier: GPL-3.0-or-later
// The frames of a projector sinogram in grey levels, for simulators: what vam-project shows of it.
#pragma once

#include <string>
#include <vector>

#include "base/pixels.hpp"
#include "model/printer.hpp"

namespace vam::session {

/// Of one turn, so many frames; 0: one for each angle. full_scale: instead of that of exposure_of(); 0: none. Of 8
/// bits, by a linear response. Throws what StackReader, FrameComposer and exposure_of() throw.
[[nodiscard]] std::vector<GreyImage> sinogram_frames(const std::string& path, const model::Printer& printer, int frames,
                                                     double full_scale);

}  // namespace vam::session

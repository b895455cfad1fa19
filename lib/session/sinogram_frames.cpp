// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/sinogram_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "io/exr/stack.hpp"
#include "model/metadata.hpp"
#include "optics/projector_frames.hpp"

namespace vam::session {

SinogramFrames sinogram_frames(const std::string& path, const model::Projector& projector, int frames,
                               double full_scale) {
  io::StackReader reader(path);
  optics::FrameComposer composer(path, reader.info(), optics::frame_place(projector, 0, 0));
  Image slice;
  for (model::ImageInfo about; reader.next(slice, about);) composer.add(slice, about.z_mm);
  composer.check();
  SinogramFrames made;
  made.full_scale = full_scale > 0
                        ? full_scale
                        : model::full_scale(reader.info().extra).value_or(static_cast<double>(composer.peak()));
  const int count = frames > 0 ? frames : reader.info().height;
  const double step_deg = 360.0 / count;
  for (int n = 0; n < count; ++n) {
    const Image light = composer.frame(n * step_deg, step_deg);
    GreyImage& grey = made.frames.emplace_back(light.width, light.height, 8);
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double share = static_cast<double>(light.values[i]) / made.full_scale;
      grey.values[i] = static_cast<std::uint16_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
    }
  }
  return made;
}

}  // namespace vam::session

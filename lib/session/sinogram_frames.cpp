// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/sinogram_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "io/exr/stack.hpp"
#include "optics/projector_frames.hpp"
#include "session/exposure.hpp"

namespace vam::session {

std::vector<GreyImage> sinogram_frames(const std::string& path, const model::Printer& printer, int frames,
                                       double full_scale) {
  io::StackReader reader(path);
  optics::FrameComposer composer(path, reader.info(), optics::frame_place(printer.projector, 0, 0));
  Image slice;
  for (model::ImageInfo about; reader.next(slice, about);) composer.add(slice, about.z_mm);
  composer.check();
  if (!(full_scale > 0)) {
    full_scale = exposure_of(path, reader.info(), printer, static_cast<double>(composer.peak())).full_scale;
  }
  std::vector<GreyImage> made;
  const int count = frames > 0 ? frames : reader.info().height;
  const double step_deg = 360.0 / count;
  for (int n = 0; n < count; ++n) {
    const Image light = composer.frame(n * step_deg, step_deg);
    GreyImage& grey = made.emplace_back(light.width, light.height, 8);
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double share = static_cast<double>(light.values[i]) / full_scale;
      grey.values[i] = static_cast<std::uint16_t>(std::lround(255 * std::clamp(share, 0.0, 1.0)));
    }
  }
  return made;
}

}  // namespace vam::session

// SPDX-License-Identifier: GPL-3.0-or-later
// A sinogram as the light that a turning part needs.
#pragma once

#include <functional>

#include "io/exr/stack.hpp"
#include "model/printer.hpp"
#include "optics/projector_frames.hpp"
#include "session/exposure.hpp"
#include "vam-project/options.hpp"
#include "vam-project/show.hpp"

namespace vam::project {

/// What to show around a stage angle, over a span of angles, in the units of the stack whose largest value is peak.
struct Light {
  std::function<Image(double angle_deg, double span_deg, const PixelRect& part, Image reused)> frame;
  double peak = 0;
  PixelRect lit;    // what is beside it is always dark
  PixelRect whole;  // frame
};

/// Reads the whole stack: a projector's, or with --flatland one slice of a virtual one. Throws Fault::data for another
/// kind of stack, and for light beside the projector.
[[nodiscard]] Light read_light(const Options& options, io::StackReader& reader, const model::Projector& projector);

/// Turns and full scale, by the plan of the stack or options. Throws as session::require_dose() does.
[[nodiscard]] session::Exposure exposure_of(const Options& options, const model::StackInfo& info, const Light& light,
                                            const model::Printer& printer);

/// As --dither says. Throws Fault::usage where several turns differ that have no whole number of frames, or do not
/// divide the turns of the print.
[[nodiscard]] Dithering dithering_of(const Options& options, double frames_per_turn, double turns);

/// Whole ones for error diffusion, or else what is lit of them. The light stays the caller's.
[[nodiscard]] Frames frames_of(const Light& light, const optics::FrameSchedule& schedule, const Dithering& dithering);

}  // namespace vam::project

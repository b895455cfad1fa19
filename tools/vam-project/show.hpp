// SPDX-License-Identifier: GPL-3.0-or-later
// From the required intensity to the frames of a device.
#pragma once

#include <functional>
#include <optional>

#include "base/image.hpp"
#include "base/pixels.hpp"
#include "base/text/json_fwd.hpp"
#include "io/image/frame_sink.hpp"
#include "model/printer.hpp"
#include "resin/response.hpp"

namespace vam::project {

struct Frames {
  int count = 0;
  double fps = 0;       // frame n belongs to the time n / fps
  double step_deg = 0;  // and to the stage angle n * step_deg
  /// The light of frame n, in the memory of `reused`. Called once for every n: in order, or by many threads at
  /// once.
  std::function<Image(int n, Image reused)> light;
  std::optional<PixelRect> lit;  // the part of every frame that light() gives; the rest is dark
  bool in_order = false;
};

/// Rounds frames, in their order, with error diffusion.
struct Dithering {
  int turns = 0;            // of which the frames differ; 0: none, each pixel to its nearest level
  int frames_per_turn = 0;  // with several turns
};

/// All frames through the grey levels into the sink, a few at a time; `scale` takes the light to fractions of full.
/// Warns of what was clipped.
resin::LightTally show(const Frames& frames, float scale, const model::Projector& projector, bool quantise,
                       const Dithering& dithering, io::FrameSink& sink);

/// For --report.
[[nodiscard]] Json figures(const Frames& frames, int bits, double peak, const resin::LightTally& tally);

}  // namespace vam::project

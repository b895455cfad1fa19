// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-project/show.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/compute/parallel.hpp"
#include "base/index.hpp"
#include "base/log/log.hpp"
#include "base/log/progress.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "optics/projector_frames.hpp"
#include "resin/dither.hpp"
#include "session/printer.hpp"

namespace vam::project {

namespace {

void warn_clipped(const resin::LightTally& tally) {
  if (tally.clipped == 0) return;
  warn(format_number(100.0 * static_cast<double>(tally.clipped) / static_cast<double>(tally.lit), 3) +
       " % of the lit pixels exceed full intensity and were clipped; reduce --multiplier or increase --full-scale");
}

void warn_dark(const resin::LightTally& tally) {
  constexpr double half_a_level = 0.5 / 255;
  const double mean = tally.lit > 0 ? tally.light / static_cast<double>(tally.lit) : 1.0;
  if (mean >= half_a_level) return;
  warn("the lit pixels have " + format_number(100 * mean, 2) +
       " % of full intensity on average, less than half a grey level: a few far brighter ones set full intensity; "
       "lower it by --full-scale");
}

/// Divides by the light that pixels give: brighter ones show less. `at`: where the light is in the frame.
void even(Image& light, const Image& flat, const PixelRect& at) {
  if (flat.values.empty()) return;
  for (int y = 0; y < light.height; ++y) {
    const float* given = flat.row(at.top + y) + at.left;
    float* row = light.row(y);
    for (int x = 0; x < light.width; ++x) row[x] /= given[x];
  }
}

/// Frames one after the other, their rows by all threads.
class DitheredFrames {
 public:
  DitheredFrames(const resin::GreyLevels& levels, const Dithering& how)
      : how_(how), dither_(levels, std::max(how.turns, 1)), dark_(static_cast<std::uint16_t>(levels.level(0))) {}

  void take(int n, const Image& intensity, int bits, GreyImage& image) {
    const bool repeats = dither_.turns() > 1;
    const int turn = repeats ? n / how_.frames_per_turn : 0;
    if (carried_.empty() || (repeats && n % how_.frames_per_turn == 0)) carried_.assign(intensity.size(), 0.0F);
    image.width = intensity.width;
    image.height = intensity.height;
    image.bits = bits;
    image.values.assign(intensity.size(), dark_);
    const auto width = static_cast<std::size_t>(intensity.width);
    parallel_for(intensity.height, [&](int y) {
      const std::span<float> carried(carried_.data() + product(y, width), width);
      if (resin::is_dark(intensity, y)) return std::fill(carried.begin(), carried.end(), 0.0F);
      std::vector<int> steps(width);
      dither_.row({intensity.row(y), width}, n % 2 == 1, carried, steps);
      for (int x = 0; x < intensity.width; ++x) {
        const int phase = 3 * x + 5 * y + 7 * (n % std::max(how_.frames_per_turn, 1));
        image.values[image.index(x, y)] = static_cast<std::uint16_t>(dither_.level(steps[x], turn, phase));
      }
    });
  }

 private:
  Dithering how_;
  resin::Dither dither_;
  std::uint16_t dark_;
  std::vector<float> carried_;
};

/// Puts what is lit of each frame into its place in the whole one, which is dark elsewhere and stays so.
class Whole {
 public:
  Whole(const Frames& frames, const model::Projector& projector, const resin::GreyLevels& levels)
      : part_(frames.lit), columns_(projector.columns), rows_(projector.rows), levels_(levels) {
    if (part_) part_ = optics::oriented(*part_, columns_, rows_, projector.orientation);
  }

  void put_levels(const Image& light, GreyImage& image) const {
    if (!part_) return resin::to_levels(light, levels_, image);
    if (image.values.empty()) {
      image = GreyImage(columns_, rows_, levels_.bits());
      std::fill(image.values.begin(), image.values.end(), static_cast<std::uint16_t>(levels_.level(0)));
    }
    resin::put_levels(light, part_->left, part_->top, levels_, image);
  }

  [[nodiscard]] Image intensity(Image light) const {
    if (!part_) return light;
    Image whole(columns_, rows_);
    for (int y = 0; y < light.height; ++y)
      std::copy_n(light.row(y), light.width, whole.row(part_->top + y) + part_->left);
    return whole;
  }

  [[nodiscard]] long pixels(const Image& light) const {
    return part_ ? static_cast<long>(columns_) * rows_ : static_cast<long>(light.size());
  }

 private:
  std::optional<PixelRect> part_;
  int columns_;
  int rows_;
  const resin::GreyLevels& levels_;
};

}  // namespace

resin::LightTally show(const Frames& frames, float scale, const model::Projector& projector, bool quantise,
                       const Dithering& dithering, io::FrameSink& sink) {
  const resin::GreyLevels levels(session::response_of(projector), projector.bits);
  DitheredFrames dithered(levels, dithering);
  const Whole whole(frames, projector, levels);
  const Image flat = session::flat_of(projector);
  std::vector<resin::LightTally> tallies(frames.count);
  const auto develop = [&](int n, io::ProjectorFrame& frame) {
    if (!frames.in_order) frame.intensity = frames.light(n, std::move(frame.intensity));
    even(frame.intensity, flat, frames.lit.value_or(PixelRect{}));
    frame.time_s = n / frames.fps;
    frame.angle_deg = n * frames.step_deg;
    tallies[n] = resin::limit_to_full(frame.intensity, scale);
    tallies[n].pixels = whole.pixels(frame.intensity);
    optics::orient(frame.intensity, projector.orientation);
    if (dithering.turns == 0) whole.put_levels(frame.intensity, frame.levels);
  };
  const auto as_shown = [&](io::ProjectorFrame& frame) {
    if (!sink.takes_intensity()) return;
    frame.intensity =
        quantise ? resin::to_intensity(frame.levels, levels) : whole.intensity(std::move(frame.intensity));
  };
  Progress progress("projecting", frames.count);
  std::vector<io::ProjectorFrame> shown(static_cast<std::size_t>(std::min(2 * threads(), frames.count)));
  const int batch = count_of(shown);
  for (int first = 0; first < frames.count; first += batch) {
    const int count = std::min(batch, frames.count - first);
    for (int i = 0; i < (frames.in_order ? count : 0); ++i) {
      shown[i].intensity = frames.light(first + i, std::move(shown[i].intensity));
    }
    parallel_for(count, [&](int i) { develop(first + i, shown[i]); });
    for (int i = 0; i < (dithering.turns > 0 ? count : 0); ++i) {
      dithered.take(first + i, shown[i].intensity, levels.bits(), shown[i].levels);
    }
    parallel_for(count, [&](int i) { as_shown(shown[i]); });
    sink.write(std::span(shown).first(count));
    progress.tick(count);
  }
  sink.commit();
  resin::LightTally all;
  for (const auto& tally : tallies) all += tally;
  warn_clipped(all);
  if (dithering.turns == 0) warn_dark(all);
  return all;
}

Json figures(const Frames& frames, int bits, double full_scale, const resin::LightTally& tally) {
  const auto lit = static_cast<double>(std::max(tally.lit, 1L));
  return {{"frames", frames.count},
          {"fps", frames.fps},
          {"step_deg", frames.step_deg},
          {"duration_s", frames.count / frames.fps},
          {"bits", bits},
          {"full_scale", full_scale},
          {"mean_intensity_fraction", tally.light / static_cast<double>(tally.pixels)},
          {"mean_lit_intensity_fraction", tally.light / lit},
          {"clipped_fraction", static_cast<double>(tally.clipped) / lit}};
}

}  // namespace vam::project

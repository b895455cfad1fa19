#include "vam-project/show.hpp"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "base/json.hpp"
#include "base/log.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "optics/frames.hpp"
#include "response.hpp"

namespace vam::project {

namespace {

void warn_clipped(const resin::LightTally& tally) {
  if (tally.clipped == 0) return;
  warn(format_number(100.0 * static_cast<double>(tally.clipped) / static_cast<double>(tally.lit), 3) +
       " % of the lit pixels exceed full intensity and were clipped; reduce --multiplier or increase --full-scale");
}

}  // namespace

resin::LightTally show(const Frames& frames, float scale, const model::Projector& projector, bool quantise,
                       io::FrameSink& sink) {
  const resin::GreyLevels levels(tool::response_of(projector), projector.bits);
  std::vector<resin::LightTally> tallies(static_cast<std::size_t>(frames.count));
  const auto develop = [&](int n, io::ProjectorFrame& frame) {
    if (!frames.in_order) frame.intensity = frames.light(n, std::move(frame.intensity));
    frame.time_s = n / frames.fps;
    frame.angle_deg = n * frames.step_deg;
    tallies[n] = resin::limit_to_full(frame.intensity, scale);
    optics::orient(frame.intensity, projector.orientation);
    resin::to_levels(frame.intensity, levels, frame.levels);
    if (quantise) frame.intensity = resin::to_intensity(frame.levels, levels);
  };
  Progress progress("projecting", frames.count);
  std::vector<io::ProjectorFrame> shown(static_cast<std::size_t>(std::min(2 * threads(), frames.count)));
  const int batch = static_cast<int>(shown.size());
  for (int first = 0; first < frames.count; first += batch) {
    const int count = std::min(batch, frames.count - first);
    for (int i = 0; i < (frames.in_order ? count : 0); ++i) {
      shown[i].intensity = frames.light(first + i, std::move(shown[i].intensity));
    }
    parallel_for(count, [&](int i) { develop(first + i, shown[i]); });
    sink.write(std::span(shown).first(count));
    progress.tick(count);
  }
  sink.commit();
  resin::LightTally all;
  for (const auto& tally : tallies) all += tally;
  warn_clipped(all);
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/shown.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/index.hpp"
#include "model/dose/figures.hpp"
#include "optimize/run/private/jobs.hpp"
#include "optimize/run/private/misses.hpp"
#include "optimize/run/private/run_totals.hpp"
#include "optimize/run/private/shown_pass.hpp"

namespace vam::optimize {

Frames::Frames(const std::vector<Image>& images) {
  for (const Image& image : images) add(image);
}

void Frames::add(const Image& image) {
  if (count_ % lanes == 0) blocks_.emplace_back(image.size() * lanes);
  replace(count_++, image);
}

void Frames::replace(int k, const Image& image) {
  const auto at = static_cast<std::ptrdiff_t>(k % lanes * image.size());
  std::copy(image.values.begin(), image.values.end(), blocks_[k / lanes].begin() + at);
}

Image Frames::at(int k, light::Shape shape) const {
  Image image(shape.width, shape.height);
  const auto size = static_cast<std::ptrdiff_t>(image.size());
  if (k < count_) std::copy_n(blocks_[k / lanes].begin() + k % lanes * size, size, image.values.begin());
  return image;
}

namespace {

void look(const Frames& frames, light::Shape shape, int slices, FramesPrint& print) {
  model::LightEfficiency seen;
  for (int k = 0; k < slices; ++k) {
    const std::vector<float> values = frames.at(k, shape).values;
    seen.add(values);
    if (k < count_of(print.demands)) print.demands[k].peak = *std::max_element(values.begin(), values.end());
  }
  print.efficiency = seen.value();
  print.peak_intensity = seen.max;
}

}  // namespace

std::vector<VolumeOutcome> prints_at(VolumeTask task, const light::Operator& light, const Frames& frames,
                                     std::span<const double> doses) {
  if (!task.demands.grey) {  // a voxel is judged by the part, whatever was demanded of it
    task.demands.surface = false;
    task.source.weight = nullptr;
    task.source.band_px = 0;
  }
  const SliceReader reader(task.source, light.object());
  const Jobs jobs = every_slice(task.source.slices, division_of(task, light));
  const light::Shape object = light.object();
  struct Print {
    RunTotals totals;
    std::optional<verdict::PrintPieceCounter> pieces;
    VolumeOutcome outcome;
  };
  std::vector<Print> prints(doses.size());
  for (std::size_t i = 0; i < doses.size(); ++i) {
    if (!task.demands.grey && doses[i] > 0) prints[i].pieces.emplace(object.width, object.height, doses[i]);
  }
  for (const Pass& pass : jobs.passes) {
    ShownPass shown = shown_pass(
        task, light, reader, pass, [](int k) { return k; }, [&](int k) { return frames.at(k, light.image()); });
    for (std::size_t i = 0; i < doses.size(); ++i) {
      auto& [totals, pieces, outcome] = prints[i];
      if (!task.demands.grey) shown.problem.demands.window = {doses[i], doses[i]};
      totals.add(shown.dose, shown.problem, pass, jobs, task.part);
      if (light.couples_slices() && !task.demands.grey) outcome.wrong = wrong_voxels(shown.dose, shown.problem);
      if (pieces) {
        count_pieces(shown.dose, shown.problem, pass.first - pass.low, pass.last - pass.low, task.source, pass.low,
                     *pieces);
      }
    }
  }
  std::vector<VolumeOutcome> outcomes;
  for (auto& [totals, pieces, outcome] : prints) {
    totals.complete(outcome, task.demands.grey, jobs.schedule.job_of_slice);
    if (pieces) outcome.pieces = pieces->found();
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

Exposed judge_shown(VolumeTask& task, const light::Operator& light, const Frames& frames, const Expose& expose,
                    const std::function<double(double)>& blur_px, VolumeOutcome& outcome) {
  constexpr int most = 8;  // more turns blur more, which may take more turns
  constexpr double rounding = 1e-6;
  Exposed exposed = expose(outcome);
  for (int times = 0; times < most; ++times) {
    const auto [threshold, seconds] = exposed;
    if (blur_px(seconds) != task.blur_px) outcome.surface.reset();
    task.blur_px = blur_px(seconds);
    static_cast<FramesPrint&>(outcome) = prints_at(task, light, frames, {{threshold}}).front();
    look(frames, light.image(), task.source.slices, outcome);
    exposed = expose(outcome);
    const bool same_dose = std::abs(exposed.threshold - threshold) <= rounding * threshold;
    if (same_dose && blur_px(exposed.seconds) == task.blur_px) break;
  }
  return exposed;
}

}  // namespace vam::optimize

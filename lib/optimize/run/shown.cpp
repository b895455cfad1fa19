// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/shown.hpp"

#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "base/index.hpp"
#include "model/figures.hpp"
#include "optimize/run/private/division.hpp"
#include "optimize/run/private/pass_light.hpp"
#include "optimize/run/private/tally.hpp"
#include "optimize/target/exclusions.hpp"

namespace vam::optimize {

namespace {

/// Of slices: from 0 on, one image each; dark ones beyond.
class Frames {
 public:
  Frames(std::span<const Image> images, light::Shape shape) : images_(images), dark_(shape.width, shape.height) {}
  [[nodiscard]] const Image& operator[](int k) const { return k < count_of(images_) ? images_[k] : dark_; }

 private:
  std::span<const Image> images_;
  Image dark_;
};

/// The light of the pass; the problem loses what inserts fill and hide.
PassLight light_of(const VolumeTask& task, const light::Operator& clear, const Pass& pass, PassInput& input,
                   Ledger& ledger) {
  std::unique_ptr<light::Operator> around;
  if (!input.inserts.empty()) {
    exclude(input.problem, input.inserts);
    around = task.around(input.inserts);
    for (const auto voxels : exclude_dark(input.problem, *around)) ledger.add_dark(voxels);
  }
  return {clear, std::move(around), task.blur_px, pass.slices()};
}

/// What prints if the resin sets at that dose: figures, and voxels on the wrong side of it slice by slice.
VolumeOutcome printed(const VolumeTask& task, const light::Operator& light, const Frames& frames, double threshold) {
  const int slices = task.source.slices;
  const light::Shape object = light.object();
  const SliceReader reader(task.source, object);
  const Division division = division_of(task, light);
  std::vector<int> each_its_own(slices);
  std::iota(each_its_own.begin(), each_its_own.end(), 0);
  const std::vector<int> once(slices, 1);
  Ledger ledger;
  VolumeOutcome outcome;
  for (int first = 0; first < slices;) {
    const Pass pass = division.from(first, slices);
    PassInput input = read_pass(
        pass, [](int k) { return k; }, reader, object, task.circle, task.demands,
        light.couples_slices() || task.blur_px > 0);
    const PassLight shown = light_of(task, light, pass, input, ledger);
    const std::vector<Slab> sinograms = collapse_images(
        pass, [&](int k) { return frames[k]; }, shown.sharp());
    std::vector<Slab> dose = slabs(sinograms.size(), object.width, object.height);
    shown.blurred().adjoint(sinograms, dose);
    add_delivered(input.problem, dose);
    input.problem.demands.window = {threshold, threshold};
    tally(dose, input.problem, pass, {task.part, each_its_own, {0, slices}, once}, ledger);
    if (light.couples_slices() && !task.demands.grey) outcome.wrong = wrong_voxels(dose, input.problem);
    first = pass.last;
  }
  ledger.complete(outcome, task.demands.grey, each_its_own);
  return outcome;
}

}  // namespace

void judge_shown(const VolumeTask& task, const light::Operator& light, std::span<const Image> frames,
                 const AimedDose& aimed, VolumeOutcome& outcome) {
  const Frames shown(frames, light.image());
  const double threshold = task.demands.window.threshold();
  VolumeOutcome judged = printed(task, light, shown, threshold);
  const double dose = task.demands.grey ? threshold : aimed(judged.metrics);
  if (dose != threshold) judged = printed(task, light, shown, dose);
  outcome.metrics = judged.metrics;
  outcome.with_cut = judged.with_cut;
  outcome.outside = judged.outside;
  outcome.wrong = std::move(judged.wrong);
  outcome.asked = std::move(judged.asked);
  outcome.surface.reset();
  model::LightEfficiency seen;
  for (int k = 0; k < task.source.slices; ++k) {
    const std::vector<float>& values = shown[k].values;
    seen.add(values);
    if (k < count_of(outcome.asked)) outcome.asked[k].peak = *std::max_element(values.begin(), values.end());
  }
  outcome.efficiency = seen.value();
  outcome.peak_intensity = seen.max;
}

}  // namespace vam::optimize

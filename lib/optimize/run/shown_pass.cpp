// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/shown_pass.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "base/index.hpp"
#include "optimize/run/private/misses.hpp"
#include "optimize/run/private/pass_setup.hpp"
#include "optimize/target/exclusions.hpp"

namespace vam::optimize {

PassSetup set_up(const VolumeTask& task, const light::Operator& light, const SliceReader& reader, const Pass& pass,
                 const std::function<int(int job)>& slice) {
  PassInput input = read_pass(pass, slice, reader, light.object(), task.circle, task.demands,
                              light.couples_slices() || task.blur_px > 0);
  std::unique_ptr<light::Operator> around;
  std::vector<std::int64_t> dark;
  if (!input.inserts.empty()) {
    exclude(input.problem, input.inserts);
    around = task.around(input.inserts);
    dark = exclude_dark(input.problem, *around);
  }
  return {std::move(input.problem), std::move(input.inserts), std::move(dark),
          PassLight(light, std::move(around), task.blur_px, pass.slices())};
}

ShownPass shown_pass(const VolumeTask& task, const light::Operator& light, const SliceReader& reader, const Pass& pass,
                     const std::function<int(int job)>& slice, const std::function<Image(int job)>& image) {
  PassSetup setup = set_up(task, light, reader, pass, slice);
  const std::vector<Slab> sinograms = collapse_images(pass, image, setup.light.sharp());
  std::vector<Slab> dose = slabs(sinograms.size(), light.object().width, light.object().height);
  setup.light.blurred().adjoint(sinograms, dose);
  add_delivered(setup.problem, dose);
  return {std::move(setup.problem), std::move(dose)};
}

void for_each_dose(const ShownPass& shown, const Pass& pass,
                   const std::function<void(int job, const float* dose)>& visit) {
  for (std::size_t s = 0; s < shown.dose.size(); ++s) {
    const int first = pass.low + static_cast<int>(s) * lanes;
    const int count = std::min(lanes, pass.high - first);
    const std::vector<float> doses = judged_doses(shown.dose[s], shown.problem.labels[s], 0, count);
    const std::size_t size = doses.size() / static_cast<std::size_t>(count);
    for (int job = std::max(first, pass.first); job < std::min(first + count, pass.last); ++job) {
      visit(job, doses.data() + product(job - first, size));
    }
  }
}

}  // namespace vam::optimize

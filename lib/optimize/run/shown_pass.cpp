// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/shown_pass.hpp"

#include <memory>
#include <utility>

#include "base/index.hpp"
#include "optimize/run/private/misses.hpp"
#include "optimize/run/private/pass_light.hpp"
#include "optimize/target/exclusions.hpp"

namespace vam::optimize {

ShownPass shown_pass(const VolumeTask& task, const light::Operator& light, const SliceReader& reader, const Pass& pass,
                     const std::function<int(int job)>& slice, const std::function<Image(int job)>& image) {
  const light::Shape object = light.object();
  PassInput input =
      read_pass(pass, slice, reader, object, task.circle, task.demands, light.couples_slices() || task.blur_px > 0);
  ShownPass shown;
  std::unique_ptr<light::Operator> around;
  if (!input.inserts.empty()) {
    exclude(input.problem, input.inserts);
    around = task.around(input.inserts);
    (void)exclude_dark(input.problem, *around);
  }
  const PassLight passed(light, std::move(around), task.blur_px, pass.slices());
  const std::vector<Slab> sinograms = collapse_images(pass, image, passed.sharp());
  shown.dose = slabs(sinograms.size(), object.width, object.height);
  passed.blurred().adjoint(sinograms, shown.dose);
  add_delivered(input.problem, shown.dose);
  shown.problem = std::move(input.problem);
  return shown;
}

void for_each_dose(const ShownPass& shown, const Pass& pass,
                   const std::function<void(int job, const float* dose)>& visit) {
  for (int job = pass.first; job < pass.last; ++job) {
    const auto slab = static_cast<std::size_t>((job - pass.low) / lanes);
    visit(job, judged_doses(shown.dose[slab], shown.problem.labels[slab], (job - pass.low) % lanes, 1).data());
  }
}

}  // namespace vam::optimize

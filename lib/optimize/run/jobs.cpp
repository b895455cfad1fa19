// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/jobs.hpp"

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "light/operators/blurred_operator.hpp"

namespace vam::optimize {

Pass Division::from(int first, int jobs) const {
  if (whole) return {0, jobs, 0, jobs};
  const int last = std::min(jobs, first + slices_per_pass - 2 * halo);
  return {first, last, std::max(0, first - halo), std::min(jobs, last + halo)};
}

Division division_of(const VolumeTask& task, const light::Operator& light) {
  if (takes_whole(task, light)) return {true, 0};
  return {false, task.blur_px > 0 ? light::halo_slices(task.blur_px) : 0};
}

bool takes_whole(const VolumeTask& task, const light::Operator& light) {
  const bool far = task.blur_px > 0 && light::halo_slices(task.blur_px) > lanes;
  return light.couples_slices() || far || task.scenarios || task.front || task.certify > 0;
}

Jobs make_jobs(Schedule schedule, const model::ImageRange& selection, const Division& division) {
  Jobs jobs{std::move(schedule), selection, {}, division, {}};
  jobs.multiplicity.assign(jobs.schedule.slice_of_job.size(), 0);
  for (int k = selection.from; k < selection.to; ++k) ++jobs.multiplicity[jobs.schedule.job_of_slice[k]];
  for (int first = 0; first < jobs.count();) {
    const Pass pass = division.from(first, jobs.count());
    const auto begin = jobs.multiplicity.begin() + pass.first;
    if (std::any_of(begin, begin + pass.jobs(), [](int slices) { return slices > 0; })) jobs.passes.push_back(pass);
    first = pass.last;
  }
  return jobs;
}

Jobs jobs_of(const VolumeTask& task, const light::Operator& light, std::span<const SliceDigest> digests) {
  const Division division = division_of(task, light);
  const model::ImageRange slices = task.slices.value_or(model::ImageRange{0, task.source.slices});
  if (slices.from < 0 || slices.count() < 1 || slices.to > task.source.slices || (task.slices && division.whole)) {
    throw Error{Fault::usage, "slices: " + model::range_text(slices) + " of " + std::to_string(task.source.slices) +
                                  " cannot be computed apart from the others"};
  }
  const light::Shape image = light.image();
  const std::size_t bytes = static_cast<std::size_t>(image.width) * image.height * sizeof(float);
  const int kept = static_cast<int>(std::max<std::size_t>(1, task.keep_bytes / bytes));
  // Slices that share light or dose with their neighbours are not alike because they look alike.
  const bool alone = division.halo == 0 && !division.whole;
  return make_jobs(make_schedule(digests, alone ? kept : -1), slices, division);
}

Jobs every_slice(int slices, const Division& division) {
  return make_jobs(make_schedule(std::vector<SliceDigest>(slices), -1), {0, slices}, division);
}

}  // namespace vam::optimize

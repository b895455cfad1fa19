// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/output_queue.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"

namespace vam::optimize {

void OutputQueue::take(std::vector<Image> images) {
  for (const Image& image : images) {
    if (std::all_of(image.values.begin(), image.values.end(), [](float v) { return std::isfinite(v); })) continue;
    throw Error{Fault::data, "projections of slice " + std::to_string(slices_) +
                                 " and those optimised with it are not finite; check the values of target and weights"};
  }
  for (Image& image : images) {
    if (jobs_.multiplicity[next_] > 0) held_.emplace(next_, std::move(image));
    if (++next_ == open()->last && ++pass_ < jobs_.passes.size()) next_ = open()->first;
  }
  write_ready();
}

void OutputQueue::write_ready() {
  for (; slices_ < jobs_.selection.to; ++slices_) {
    if (!jobs_.selection.holds(slices_)) continue;
    const int job = jobs_.schedule.job_of_slice[slices_];
    const auto found = held_.find(job);
    if (found == held_.end()) return;
    const std::vector<float>& values = found->second.values;
    peaks_[slices_] = *std::max_element(values.begin(), values.end());
    efficiency_.add(values);
    write_(slices_, found->second);
    if (jobs_.schedule.last_slice[job] == slices_) held_.erase(found);
  }
}

}  // namespace vam::optimize

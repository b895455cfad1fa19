// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/finished.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"

namespace vam::optimize {

void Finished::take(std::vector<Image> images) {
  for (const Image& image : images) {
    if (std::all_of(image.values.begin(), image.values.end(), [](float v) { return std::isfinite(v); })) continue;
    throw Error{Fault::data, "projections of slice " + std::to_string(slices_) +
                                 " and those optimised with it are not finite; check the values of target and weights"};
  }
  for (Image& image : images) held_.emplace(jobs_++, std::move(image));
  for (; slices_ < count_of(schedule_.job_of_slice); ++slices_) {
    const int job = schedule_.job_of_slice[slices_];
    if (job >= jobs_) return;
    const auto found = held_.find(job);
    const std::vector<float>& values = found->second.values;
    const bool asked = asked_.holds(slices_);
    peaks_.push_back(asked && !values.empty() ? *std::max_element(values.begin(), values.end()) : 0);
    if (asked) efficiency_.add(values);
    if (asked) write_(slices_, found->second);
    if (schedule_.last_slice[job] == slices_) held_.erase(found);
  }
}

}  // namespace vam::optimize

// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/run/private/division.hpp"

#include <algorithm>

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

}  // namespace vam::optimize

// SPDX-License-Identifier: GPL-3.0-or-later
#include "optimize/target/void_rule.hpp"

#include <algorithm>
#include <vector>

#include "model/dose/dose_metrics.hpp"

namespace vam::optimize {

VolumeSource::Read with_void(const VolumeSource::Read& target, const VolumeSource::Read& values, float usual,
                             std::size_t pixels, const std::function<void(float&)>& change) {
  return [=](int k, int count, float* out) {
    const std::size_t all = static_cast<std::size_t>(count) * pixels;
    std::vector<float> wanted(all);
    target(k, count, wanted.data());
    if (values) values(k, count, out);
    if (!values) std::fill_n(out, all, usual);
    for (std::size_t i = 0; i < all; ++i) {
      if (wanted[i] <= model::coverage_rounding) change(out[i]);
    }
  };
}

}  // namespace vam::optimize

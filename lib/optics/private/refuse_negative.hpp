// SPDX-License-Identifier: GPL-3.0-or-later
// No projector shows negative light.
#pragma once

#include <algorithm>
#include <string>

#include "base/error.hpp"
#include "base/image.hpp"
#include "base/text/text.hpp"
#include "model/stack.hpp"

namespace vam::optics {

/// Names the lowest value of a sinogram. Throws Fault::data.
[[noreturn]] inline void refuse_negative(const std::string& subject, const Image& sinogram,
                                         const model::StackInfo& info, double z_mm) {
  const auto lowest = std::min_element(sinogram.values.begin(), sinogram.values.end());
  const auto at = lowest - sinogram.values.begin();
  const auto row = at / sinogram.width;
  const double angle_deg = info.angle_start_deg + static_cast<double>(row) * info.angle_step_deg;
  throw Error{Fault::data, subject + ": has a value of " + format_number(*lowest) + " at z = " + format_number(z_mm) +
                               " mm, " + format_number(angle_deg) + " deg, column " +
                               std::to_string(at % sinogram.width) +
                               "; intensity cannot be negative: clip or offset it in vam-sinogram"};
}

}  // namespace vam::optics

// SPDX-License-Identifier: GPL-3.0-or-later
// The figures of merit by name, in the order of tables, traces and reports.
#pragma once

#include <string>
#include <vector>

#include "model/dose/dose_metrics.hpp"

namespace vam::model {

/// latitude, ver, pw, ipdr, cv, iou, threshold, min_part, max_part, mean_part, max_void, max_dose
[[nodiscard]] const std::vector<std::string>& figure_names();

/// NaN for a name that is not there.
[[nodiscard]] double figure(const DoseMetrics& metrics, const std::string& name);

}  // namespace vam::model

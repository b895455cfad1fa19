// SPDX-License-Identifier: GPL-3.0-or-later
// Reports of vam-sdf on a page: verdict, figures with their uncertainties, histogram.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vam::report_tool {

/// Of the first report of vam-sdf among the files.
struct InspectionViews {
  std::string verdict;  // HTML; empty where no conditions were given
  std::string figures;  // HTML table
  std::string histogram;
  double limit_mm = 0;  // of the print's colours
};
/// Nothing without such a report. Throws Fault::data for a seal that is not its own.
[[nodiscard]] std::optional<InspectionViews> inspection_views(const std::vector<std::string>& reports);

}  // namespace vam::report_tool

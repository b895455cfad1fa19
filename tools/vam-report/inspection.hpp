// SPDX-License-Identifier: GPL-3.0-or-later
// Reports of vam-sdf on a page: verdict, figures with their uncertainties, histogram.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vam::report_tool {

/// Standard uncertainties of a print's surface, of which those of its dimensions follow [GUM08].
struct DimensionErrors {
  double surface_mm = 0;  // of single points
  double common_mm = 0;   // of the whole surface at once, outwards
  double scale = 0;       // relative
  /// Expanded, k = 2, of the distance of the outermost points on two opposite sides. These lie beyond faces by up to
  /// 2.5 standard deviations of points each.
  [[nodiscard]] double expanded_mm(double size_mm) const;
};

/// Views of the first report of vam-sdf among the files.
struct InspectionViews {
  std::string verdict;  // HTML; empty where no conditions were given
  std::string figures;  // HTML table
  std::string histogram;
  double limit_mm = 0;  // of the print's colours
  DimensionErrors errors;
};
/// Nothing without such a report. Throws Fault::data for a seal that is not its own.
[[nodiscard]] std::optional<InspectionViews> inspection_views(const std::vector<std::string>& reports);

}  // namespace vam::report_tool

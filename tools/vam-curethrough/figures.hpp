// SPDX-License-Identifier: GPL-3.0-or-later
// Tables and figures of the results.
#pragma once

#include <string>
#include <vector>

#include "base/image.hpp"
#include "resin/curethrough/cure_map.hpp"
#include "resin/curethrough/sweep.hpp"
#include "vam-curethrough/print.hpp"

namespace vam::curethrough {

/// An x-z plane, first slice at the top as in [CURE19 fig 2]: row n is slice n.
struct PlaneFigure {
  int row = 0;                // y of the plane
  int column = 0;             // x of the curves
  Image light;                // fractions of the maximum intensity
  Image cure;                 // resin::Cure
  Image solid;                // 1 in the part
  std::vector<double> omega;  // at the slices' centres, in that column
};

[[nodiscard]] Json to_json(const resin::CureTotals& totals, const resin::Process& process);
[[nodiscard]] std::string table_of(const resin::CureTotals& totals, const resin::Process& process);

/// As [CURE19 fig 2b-d and 4a-c]: the slices, the cure map, grey and dose along the column.
void draw_plane(const std::string& path, const PlaneFigure& plane, const PrintSettings& print);
/// As [CURE19 fig 5c]: the ratio of height errors against the assumed full-cure dose.
void draw_study(const std::string& path, const std::vector<resin::StudyPoint>& points, double slice_um);

}  // namespace vam::curethrough

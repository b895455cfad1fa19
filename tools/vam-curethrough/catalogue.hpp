// SPDX-License-Identifier: GPL-3.0-or-later
// Several resins for one part: how fast, and how narrow a gap stays open.
#pragma once

#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "resin/curethrough/part_columns.hpp"
#include "vam-curethrough/print.hpp"

namespace vam::curethrough {

/// Prints the table of the resins in that file (CSV) on standard output and returns it for the report. `clear`: largest
/// dose, in full-cure doses, in a gap that stays open. Without speeds each resin has some of its own.
[[nodiscard]] Json compare(const std::string& path, const std::vector<double>& speeds_mm_h, double clear,
                           const PrintSettings& print, const resin::PartColumns& part);

}  // namespace vam::curethrough

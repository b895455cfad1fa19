// SPDX-License-Identifier: GPL-3.0-or-later
// Regions of a print that vam-sdf measures separately, and tolerances: --region and --tolerance.
#pragma once

#include <optional>
#include <vector>

#include "metrology/compare/regions.hpp"
#include "vam-sdf/options.hpp"

namespace vam::sdf_tool {

struct Toleranced {
  std::optional<double> tolerance_mm;      // of the whole print
  std::vector<metrology::Region> regions;  // each with its own tolerance, or that of the whole print
};

/// The faces of regions are read. Throws Fault::usage when a name is given twice or not at all, or a tolerance is not a
/// length above 0.
[[nodiscard]] Toleranced read_regions(const Options& options);

}  // namespace vam::sdf_tool

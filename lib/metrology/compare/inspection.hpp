// SPDX-License-Identifier: GPL-3.0-or-later
// All figures of a print.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "metrology/compare/deviation.hpp"
#include "metrology/compare/regions.hpp"
#include "solid/mesh/signed_distance.hpp"

namespace vam::metrology {

/// How a print was aligned, for what its errors do to the pose.
struct AlignmentFacts {
  bool aligned = false;
  bool with_scale = false;
  double shrinkage_percent = 0;
  std::vector<std::string> datum;  // regions; empty: the whole surface
};

struct Inspection {
  Distances distances;
  std::vector<solid::ClosestPoint> feet;  // on the design, of distances.on_print, where there are regions
  std::vector<RegionPoints> regions;
  std::optional<double> tolerance_mm;
  AlignmentFacts pose;
};
[[nodiscard]] Inspection inspect(const model::TriangleSoup& print, const model::TriangleSoup& design_mesh,
                                 const solid::Surface& design, int samples, const std::vector<Region>& regions);

/// The figures as in the report: those of to_json(Comparison), within_percent, alignment.shrinkage_percent, regions.
[[nodiscard]] Json figures_json(const Inspection& inspection);

}  // namespace vam::metrology

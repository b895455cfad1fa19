// All figures of a print, with their expanded uncertainties [GUM08; physics §8].
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/json_fwd.hpp"
#include "metrology/compare/deviation.hpp"
#include "metrology/compare/regions.hpp"

namespace vam::metrology {

/// What is known of the errors of a print's surface. Standard uncertainties along the normal.
struct SurfaceErrors {
  std::string source;            // "volume", "mesh" or "roughness"
  std::vector<float> vertex_mm;  // of each vertex of the print, independent from cell to cell
  double cell_mm = 0;
  double common_mm = 0;  // of the whole surface at once: that of the isovalue
  double scale = 0;      // relative: that of the camera's pixel pitch
};

/// From the mesh alone: how the distances of neighbouring vertices differ, 1.4826 times the median magnitude over
/// sqrt(2), for edges shorter than 2 % of the design. What neighbours have in common is not seen.
[[nodiscard]] SurfaceErrors roughness(const model::TriangleSoup& print, const solid::Surface& design,
                                      double largest_dimension_mm);
/// RMS of the vertices, cell, and the common parts, for a report.
[[nodiscard]] Json to_json(const SurfaceErrors& errors);
/// Mean edge of a mesh: the cells of its errors.
[[nodiscard]] double mean_edge_mm(const model::TriangleSoup& mesh);

/// How a print was aligned, for what its errors do to the pose.
struct AlignmentFacts {
  bool aligned = false;
  bool with_scale = false;
  double shrinkage_percent = 0;
  std::vector<std::string> datum;  // regions; empty: the whole surface
};

struct Inspection {
  Distances distances;
  std::vector<solid::Foot> feet;  // nearest points of the design for distances.on_print, where there are regions
  std::vector<RegionPoints> regions;
  std::optional<double> tolerance_mm;
  AlignmentFacts pose;
};
[[nodiscard]] Inspection inspect(const model::TriangleSoup& print, const model::TriangleSoup& design_mesh,
                                 const solid::Surface& design, int samples, const std::vector<Region>& regions);

/// The figures as in the report: those of to_json(Comparison), within_percent, alignment.shrinkage_percent, regions.
[[nodiscard]] Json figures_json(const Inspection& inspection);

/// Of each of these figures the expanded uncertainty (k = 2), under the same keys, by Monte Carlo [JCGM08]: 20 trials
/// disturb the distances by drawn errors, take out what the alignment would, and measure a quarter of the points;
/// twice the standard deviation and mean departure combined. The mean departure of an extreme counts 1 / (sqrt(2) - 1)
/// times, as it has the noise of the print already.
[[nodiscard]] Json expanded_uncertainty(const Inspection& inspection, const model::TriangleSoup& print,
                                        const SurfaceErrors& errors);

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
// How far a print is from its design: statistics of signed distances [OST22 section 3, Table S1].
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "model/mesh.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "solid/mesh/surface_samples.hpp"

namespace vam::metrology {

/// Statistics of signed distances in mm, positive where the print stands outside the design. Of samples of equal
/// area: vertices would weight a surface by how finely it is meshed.
struct SurfaceDeviation {
  std::size_t samples = 0;
  double rms_mm = 0;
  double mean_mm = 0;
  double sigma_mm = 0;    // standard deviation about the mean
  double mad_mm = 0;      // median absolute deviation from the median
  double trimmed_mm = 0;  // RMS of the 95 % nearest to the design: a crumb or a bubble does not decide it
  double min_mm = 0;
  double max_mm = 0;
  double max_abs_mm = 0;                                  // one-sided Hausdorff distance of the samples
  std::vector<std::pair<double, double>> percentiles_mm;  // (per cent, mm)
};

/// Throws Fault::data when there are no distances.
[[nodiscard]] SurfaceDeviation deviation(std::span<const float> distances_mm);

/// Per cent of the distances within +-tolerance_mm.
[[nodiscard]] double within_percent(std::span<const float> distances_mm, double tolerance_mm);

/// How much shorter a print is along x, y and z of its design, in per cent, its growth all around included: what
/// callipers find. A shift and a small turn, which the alignment has left, are fitted with it. From distances along the
/// normals at points of the design, by the least sum of absolute misses, which crumbs and missing pieces do not pull
/// [physics §8].
[[nodiscard]] std::array<double, 3> axis_shrinkage_percent(std::span<const solid::SurfaceSample> design,
                                                           std::span<const float> distances_mm);

/// Distances in mm between two surfaces, at points of both; positive: print outside the design.
struct Distances {
  std::vector<solid::SurfaceSample> on_print;
  std::vector<float> print_mm;
  std::vector<solid::SurfaceSample> on_design;
  std::vector<float> design_mm;
  double largest_dimension_mm = 0;  // of the design
};
[[nodiscard]] Distances measure(const model::TriangleSoup& print, const model::TriangleSoup& design_mesh,
                                const solid::Surface& design, int samples);

/// Both directions: print to design, and design to print with the sign turned so that positive still means
/// "print outside the design"; what is missing in the print shows only in the second.
struct Comparison {
  SurfaceDeviation print_to_design;
  SurfaceDeviation design_to_print;
  double hausdorff_mm = 0;
  double largest_dimension_mm = 0;            // of the design; percentages refer to it
  std::array<double, 3> shrinkage_percent{};  // along x, y and z
};
[[nodiscard]] Comparison compare(const Distances& distances);

/// Blue (inside, -limit) over white (0) to red (outside, +limit), as CloudCompare's and [OST22 fig 6]'s scale.
[[nodiscard]] std::array<std::uint8_t, 3> blue_white_red(double distance_mm, double limit_mm);

[[nodiscard]] Json to_json(const Comparison& comparison);

}  // namespace vam::metrology

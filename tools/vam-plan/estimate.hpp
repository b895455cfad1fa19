// SPDX-License-Identifier: GPL-3.0-or-later
// The verdict on a print of few iterations, on voxels that are larger for large parts.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/printer.hpp"
#include "optimize/run/yield.hpp"
#include "score/exposure.hpp"
#include "solid/voxel/part.hpp"
#include "verdict/verdict.hpp"

namespace vam::plan_tool {

/// A part on voxels of some size.
struct Filled {
  model::Volume volume;
  solid::FillSummary content;
};
/// Throws Error: no_memory.
[[nodiscard]] Filled filled(const solid::Part& part, double voxel_mm);
[[nodiscard]] inline solid::Part without_surface(solid::Part part) {
  part.surface = {};
  return part;
}

/// Heights in the print: slices with wrong voxels, and the one with most of them.
struct WrongHeights {
  double low_mm, high_mm, worst_mm;
};

struct Estimate {
  double voxel_mm = 0;
  int angles = 0, iterations = 0;       // 0: no voxel is wholly inside the part
  verdict::Verdict verdict;             // left open: "unknown at 0.26 mm; --voxel 0.1 tells: ..."
  bool fails = false;                   // the print of the estimate, whether or not that is left open
  std::vector<std::string> too_coarse;  // then: what voxels larger than those of the print do not resolve
  std::optional<WrongHeights> wrong;
  optimize::Trials trials;                        // of what is expected of the printer
  std::vector<std::pair<int, double>> by_angles;  // optimize::Preview
  bool resin_known = false;
  std::optional<score::ExposurePlan> exposure;  // none: the resin is not known, or gets no light

  [[nodiscard]] bool is_unknown() const { return verdict.answer == verdict::Answer::left_open; }
};

/// The part as it is sliced, and its printer.
struct EstimateTask {
  const solid::Part& part;
  const model::Printer& printer;
  model::Grid grid;                      // of the final print
  verdict::SubVoxelFeatures unresolved;  // of its voxels
  double thinnest_voxels = 0;            // the thinnest wall or place of it; 0: less than what is measured
  bool sharp_edges = false;              // thinner than what prints
  double stretch_z = 1;
  bool on_these_voxels = false;  // however long it takes
};

/// Estimates on voxels four times as large as those of the print, or larger by another power of 2 where the part has
/// more than 2 million of these; then on smaller ones, while the estimate does not decide and they are few.
[[nodiscard]] Estimate estimated(const EstimateTask& task);

}  // namespace vam::plan_tool

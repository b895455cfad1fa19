// SPDX-License-Identifier: GPL-3.0-or-later
// Yield over deviating printers at one exposure, the tolerance with the smallest margin, and the deviations that end
// the print: the dose of each printer is computed by its own forward model.
#pragma once

#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/grid.hpp"
#include "model/tolerances.hpp"
#include "optimize/methods/scenarios.hpp"
#include "optimize/run/shown.hpp"
#include "optimize/run/volume.hpp"

namespace vam::optimize {

/// What is judged: frames for the printer as set, one image a slice, in fluence; doses at grid and circle of the
/// target.
struct Trial {
  TolerantPrinter printer;
  model::Grid grid;
  double threshold = 0.8;  // dose at which the resin sets
  int printers = 0;        // of the yield
  bool ends = false;       // find the deviations that end the print, which the printer as set prints
};

/// The print of one printer.
struct Printed {
  model::DoseMetrics figures;  // doses in units of the threshold
  double wrong = 0;            // fraction of voxels on the wrong side of the threshold
  /// The least distance of any dose from the threshold; negative: on the wrong side.
  [[nodiscard]] double margin() const;
};

/// One deviation alone, both ways.
struct Single {
  std::size_t tolerance = 0;  // of model::tolerance_table
  Printed minus, plus;        // at the tolerance
  double ends_at = 0;         // the least deviation, with its sign, at which a voxel is on the wrong side; 0: not known
  [[nodiscard]] double least_margin() const;
};
inline constexpr double farthest_end = 8;  // tolerances

struct Trials {
  model::Tolerances tolerances{};
  Printed nominal;
  std::vector<Single> singles;  // of every tolerance that is not 0; with Trial::ends those first that end it first
  int printers = 0, good = 0;   // of printers that are drawn, those with at most allowed_wrong
  std::size_t costliest = 0;    // of model::tolerance_table: its least margin is the smallest
};
inline constexpr double allowed_wrong = 1e-3;

/// The print of the printer as set.
[[nodiscard]] Printed print_as_set(const Trial& trial, const VolumeTask& task, const Frames& frames);

/// Ends within the tolerances are found to 2 %, and where there is none the first beyond, up to farthest_end; an
/// eccentric vial is left out where the part is near its wall. Memory: all doses and frames once. Throws Fault::data as
/// light::Simulation does.
[[nodiscard]] Trials run_trials(const Trial& trial, const VolumeTask& task, const Frames& frames);

/// "; sinking of 0.08 mm (expected: 0.1 mm) ends it first, then ..."; or that there is no end, as the printer as set
/// does not print it: by the verdict, or by voxels alone.
[[nodiscard]] std::string words_of_ends(const Trials& trials, bool prints);
/// For --report.
[[nodiscard]] Json report(const Trials& trials);

}  // namespace vam::optimize

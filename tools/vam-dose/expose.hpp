// SPDX-License-Identifier: GPL-3.0-or-later
// From sinograms to doses of one turn.
#pragma once

#include <cstdint>
#include <optional>

#include "io/vdb/vdb.hpp"
#include "light/simulation/display_range.hpp"
#include "model/dose/dose_metrics.hpp"
#include "model/dose/stray_cure.hpp"
#include "model/printer.hpp"
#include "score/exposure.hpp"
#include "vam-dose/light.hpp"
#include "vam-dose/options.hpp"
#include "vam-dose/place.hpp"

namespace vam::dose_tool {

/// Results of the simulation.
struct Exposed {
  light::LightSeen light;
  double shown_turns = 0;  // mean over the stage angles, with --shown
  bool climbs = false;     // rays that climb were followed
  double seconds = 0;      // during which the dose diffuses; 0 where it does not
  double blur_mm = 0;      // standard deviation of the blur by beam and resin; 0 if neglected
  score::TurnDoses doses;
  model::DoseMetrics metrics;                    // of part and void, with a target
  std::optional<model::StrayDoses> outside;      // of the part's box, with a target
  std::optional<std::int64_t> dark_part_voxels;  // that the insert shadows from all stage angles
};

/// `info`: of the stack, with the poses to judge it by. Fills the volume, a batch of slices at a time, in units of
/// intensity times radian. Warns of negative intensities and of part voxels that are in shadow.
[[nodiscard]] Exposed expose(Light& light, const model::StackInfo& info, const Options& options,
                             const model::Printer& printer, const Place& place, io::SparseVolume& volume);

}  // namespace vam::dose_tool

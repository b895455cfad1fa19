// SPDX-License-Identifier: GPL-3.0-or-later
// The volumes of a job.
#pragma once

#include <vector>

#include "io/vdb/vdb.hpp"
#include "optimize/target/slice_reader.hpp"
#include "session/job_options.hpp"
#include "session/scene.hpp"

namespace vam::session {

/// Those after the target may be missing. All are on one grid but the dose that was delivered,
/// which is that of all resin that light reaches.
struct JobVolumes {
  std::vector<io::SparseVolume> target, insert, weight, tolerance;  // at most one each
  std::vector<io::SparseVolume> delivered;                          // doses, which add

  [[nodiscard]] const model::Grid& grid() const { return target.front().grid(); }
};

/// Target, insert, weight and tolerance of the target's file; the latter two may have files of their own, as the dose
/// that was delivered has. Throws Fault::data when there is no target, another of these is on another grid, or the dose
/// is not in mJ/cm3.
[[nodiscard]] JobVolumes read(const JobOptions& options);

/// Their slices in the grid of the scene, the dose that was delivered in the unit of the projections' dose: over their
/// threshold as the dose is over the resin's. All are referred to. Throws Fault::usage when the resin's critical dose
/// is not known, Fault::data when the dose is on another grid than the light's.
[[nodiscard]] optimize::VolumeSource source_of(const JobVolumes& in, const Scene& scene, const JobOptions& options);

}  // namespace vam::session

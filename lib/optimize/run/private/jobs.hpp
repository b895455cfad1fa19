// SPDX-License-Identifier: GPL-3.0-or-later
// The work of a run: equal slices share a job, and jobs are optimised in passes.
#pragma once

#include <span>
#include <vector>

#include "light/operators/operator.hpp"
#include "model/piece.hpp"
#include "optimize/run/private/pass.hpp"
#include "optimize/run/volume.hpp"
#include "optimize/target/schedule.hpp"

namespace vam::optimize {

/// How jobs are divided into passes.
struct Division {
  bool whole = false;  // all slices are one pass
  int halo = 0;        // slices that a pass knows on both sides of its own

  /// The pass that begins with job `first` of `jobs`.
  [[nodiscard]] Pass from(int first, int jobs) const;
};

[[nodiscard]] Division division_of(const VolumeTask& task, const light::Operator& light);

struct Jobs {
  Schedule schedule;              // which slice is computed as which job
  model::ImageRange selection;    // slices that are computed
  std::vector<int> multiplicity;  // of each job: selected slices that share it
  Division division;
  std::vector<Pass> passes;  // with one of them; others are not computed

  [[nodiscard]] int count() const { return static_cast<int>(multiplicity.size()); }
  [[nodiscard]] int slice(int job) const { return schedule.slice_of_job[job]; }
};

[[nodiscard]] Jobs make_jobs(Schedule schedule, const model::ImageRange& selection, const Division& division);
/// The jobs of the slices that the task selects. Throws Fault::usage where these cannot be computed apart.
[[nodiscard]] Jobs jobs_of(const VolumeTask& task, const light::Operator& light, std::span<const SliceDigest> digests);
/// A job for each slice.
[[nodiscard]] Jobs every_slice(int slices, const Division& division);

}  // namespace vam::optimize

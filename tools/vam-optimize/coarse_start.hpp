// SPDX-License-Identifier: GPL-3.0-or-later
// Projections to start from: those of the same part on the same bench at half of the resolution, which start from
// those at a quarter, and so on. An iteration takes an eighth of the time there, and what is left to the full
// resolution is fine: nested iteration, as in multigrid methods [BHM00].
#pragma once

#include <optional>
#include <vector>

#include "base/image.hpp"
#include "optimize/run/prolongation.hpp"
#include "optimize/run/volume.hpp"
#include "session/job_volumes.hpp"
#include "session/scene.hpp"
#include "vam-optimize/options.hpp"

namespace vam::optimize_tool {

/// Those of the same job on voxels of twice the size: half of the angles and bins, and nothing that is made of the
/// result alone.
[[nodiscard]] Options coarser(const Options& options);

struct CoarseStart {
  optimize::Prolongation images;  // of the finer problem's slices
  double half_width = 0;          // of the window that it reached about the threshold, in doses; 0: it did not print
  optimize::EvenDose even;        // these two do not depend on the voxels
  double eigenvalue = 0;
  double max_intensity = 0;  // the limit, as raised; 0: none
};

/// For the projections of `scene`, from `in`; a line for each level on a terminal. None where the coarser part is too
/// small to be of use, or has no light that prints it, nearly; and after an interruption, for which
/// device::interrupted() is to be asked.
[[nodiscard]] std::optional<CoarseStart> coarse_start(const session::JobVolumes& in, const session::Scene& scene,
                                                      const Options& options);

/// A problem solved, with its projections.
struct SolvedLevel {
  optimize::VolumeOutcome outcome;
  std::vector<Image> images;
};
[[nodiscard]] SolvedLevel solved(optimize::VolumeTask& task, const session::Scene& scene, const Options& options);

/// The start of a finer level from one that is solved; none where that has no light that prints the part, nearly.
[[nodiscard]] std::optional<CoarseStart> start_of(SolvedLevel level, const session::Scene& scene,
                                                  const Options& options, const session::Scene& finer,
                                                  const Options& finer_options);

/// The task starts from it.
void continue_from(CoarseStart start, optimize::VolumeTask& task, Options& options);

}  // namespace vam::optimize_tool

// SPDX-License-Identifier: GPL-3.0-or-later
// A whole volume, pass by pass in constant memory: distinct slices are packed, optimised, brought to one printing
// threshold, and handed out in ascending order.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/image.hpp"
#include "base/text/json_fwd.hpp"
#include "model/dose/stray_cure.hpp"
#include "model/piece.hpp"
#include "optimize/run/certify.hpp"
#include "optimize/run/checkpoint_state.hpp"
#include "optimize/run/even_dose.hpp"
#include "optimize/run/front.hpp"
#include "optimize/run/shortest.hpp"
#include "optimize/target/slice_reader.hpp"
#include "verdict/verdict.hpp"

namespace vam::optimize {

/// Upper bound on projected intensity. Even intensity is the one that, projected by every pixel at every angle, gives
/// the threshold dose on average.
struct IntensityLimit {
  double most = 0;     // 0: none
  double of_even = 0;  // else this multiple of the even intensity
};

struct VolumeTask {
  std::string title = "optimising";  // of the progress
  VolumeSource source;
  /// Only these slices are written. They are optimised in the passes of the whole volume, so that their projections are
  /// those of a run without this. Fault::usage where the volume has too few, or all are one pass.
  std::optional<model::ImageRange> slices;
  Circle circle;
  model::VoxelBox part;                  // its box
  verdict::SubVoxelFeatures unresolved;  // of the target, whose surface tells its pieces
  Demands demands;
  Limits limits;
  IntensityLimit limit;
  Raising raising;     // of the limit, while the goal is not met
  double blur_px = 0;  // Gaussian that smears the dose, in voxels: neighbouring slices are then optimised together
  bool watch = false;  // fill the trace
  std::size_t keep_bytes = std::size_t{512} << 20U;  // finished projections held for identical slices to come
  std::function<std::unique_ptr<light::Operator>(std::span<const Slab>)>
      around;  // the operator of a pass with these inserts
  /// Printers off their settings around these inserts, for methods that face them; may be empty.
  std::function<std::vector<Scenario>(std::span<const Slab>)> scenarios;
  std::function<Image(int k)> initial;  // image to start from (fluence); none = from nothing
  std::function<std::unique_ptr<Method>(double max_intensity)> make;
  std::function<void(int k, const Image& image)> write;  // takes the slices in order: columns x angles, fluence
  int certify = 0;  // iterations that prove how good any light could be, after the work; 0: no proof
  Show front;       // fills the outcome's front while the limit is raised; empty: none
  CheckpointState checkpoint;
};

/// What a slice asks of the exposure that all slices share.
struct SliceDemand {
  double min_part = -1;  // least dose of its part; -1: none
  double max_void = -1;  // largest dose of its void; -1: none
  double peak = 0;       // largest intensity
};

/// What finished projections print.
struct FramesPrint {
  model::DoseMetrics metrics;                  // at the common threshold
  bool all_cut = false;                        // no voxel is wholly inside the part, and these are as with_cut
  model::DoseMetrics with_cut;                 // with the voxels that the surface cuts: part from half coverage on
  std::optional<model::StrayCure> outside;     // of the part's box, at that threshold; none of a grey target
  std::vector<std::int64_t> wrong;             // of each slice where they share light, as prints_at() finds them,
  std::optional<verdict::PrintPieces> pieces;  // and these, but of a grey target
  std::vector<SliceDemand> demands;            // by each slice; empty of a grey target
  double efficiency = 0;
  double peak_intensity = 0;

  /// As it is judged, its pieces on a grid of these voxels.
  [[nodiscard]] verdict::GivenPrint print(const model::Grid& grid, double stretch_z,
                                          const model::LightWidth& by) const {
    verdict::GivenPrint made{metrics, with_cut, pieces, grid, stretch_z, by};
    if (all_cut) made.whole.part = 0;
    return made;
  }
};

struct VolumeOutcome : FramesPrint {
  int jobs = 0;                              // distinct slices computed
  int iterations = 0;                        // most of any pass
  StopReason stop = StopReason::iterations;  // of the pass with most iterations; interrupted: there is no result
  double growth = no_growth_known;           // Outcome::growth of that pass
  double seconds = 0;                        // that the optimisation took
  std::vector<model::DoseMetrics> trace;     // after 0, 1, ... iterations (SliceFigures::mean), when watched
  std::optional<SurfaceMiss> surface;        // where slices share light
  double least_ratio = 0;                    // Method::provable_ratio(), the largest of all passes
  double max_intensity = 0;                  // the limit, as raised; 0: none
  EvenDose even;                             // where the limit asked for it, else 0
  double even_intensity = 0;                 // 0: not asked for
  std::optional<Certificate> certificate;    // when asked for
  std::vector<FrontPoint> front;             // by rising limit, when asked for
  std::int64_t dark_part_voxels = 0;         // of the part, behind the insert from everywhere
};

/// Whether all slices are one pass: where light couples them, where a figure is of the whole part, and where the blur
/// reaches farther than passes overlap.
[[nodiscard]] bool takes_whole(const VolumeTask& task, const light::Operator& light);

/// Slices of a part are optimised only where light and figures leave passes independent. All calls of the task's
/// functions come from the calling thread. Throws Fault::data when a slice has part outside the circle, and when the
/// state to go on from is of another job; Fault::usage when a blur is to be compensated by a method that does not keep
/// doses to scale.
VolumeOutcome optimise(const VolumeTask& task, const light::Operator& light);

/// For --report and --trace.
[[nodiscard]] Json report(const VolumeOutcome& outcome);
[[nodiscard]] std::string trace_csv(const std::vector<model::DoseMetrics>& trace);

}  // namespace vam::optimize

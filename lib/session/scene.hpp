// SPDX-License-Identifier: GPL-3.0-or-later
// Projector, vial and part, and the light between them, from printer, target and options.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/index.hpp"
#include "io/vdb/vdb.hpp"
#include "light/grids/lit_grid.hpp"
#include "light/operators/operator.hpp"
#include "light/rays/vial_setup.hpp"
#include "model/circle.hpp"
#include "model/grid.hpp"
#include "model/pose.hpp"
#include "model/printer.hpp"
#include "optimize/methods/scenarios.hpp"
#include "session/job_options.hpp"
#include "tomo/radon.hpp"

namespace vam::session {

/// Geometry of projector, vial and target.
struct Scene {
  model::Grid grid;  // all that the light reaches: the target's and a margin around it
  light::Margin margin;
  model::Printer printer;
  model::Circle circle;         // what it reaches
  tomo::ParallelGeometry turn;  // with --geometry parallel
  model::Poses poses;           // of the frames; none: one turn in which nothing is displaced
  int rows = 0;                 // of light, from first_row_mm on
  double first_row_mm = 0;

  /// Rows of a sinogram.
  [[nodiscard]] int frames() const { return poses.empty() ? turn.angles : count_of(poses); }
};

[[nodiscard]] Scene make_scene(const io::SparseVolume& target, const model::Printer& printer,
                               const JobOptions& options);
/// Warns of a part beyond the writable radius, and of a wobble in the calibration records that the poses leave out.
void warn_of(const Scene& scene, const io::SparseVolume& target, const JobOptions& options);

/// Time of diffusion that the light compensates for.
[[nodiscard]] double diffusion_s(const Scene& scene, const JobOptions& options);
/// Standard deviation in voxels of the blur by beam and resin in that time; 0 if neglected.
[[nodiscard]] double blur_px(const model::Resin& resin, double seconds, const Scene& scene, const JobOptions& options);

/// Parallel beam or chief rays of the projector, with the resin's absorption unless neglected; around opaque inserts if
/// there are any, a slab for every slab of the pass.
[[nodiscard]] std::unique_ptr<light::Operator> make_light(const Scene& scene, const JobOptions& options,
                                                          std::span<const Slab> inserts = {});

/// The printer with these tolerances, whose dose diffuses for so long. Scene and options are referred to.
[[nodiscard]] optimize::TolerantPrinter tolerant(const Scene& scene, const JobOptions& options,
                                                 const model::Tolerances& tolerances, double seconds);

}  // namespace vam::session

// SPDX-License-Identifier: GPL-3.0-or-later
// What a plan says.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "base/json_fwd.hpp"
#include "model/grid.hpp"
#include "model/part_surface.hpp"
#include "model/printer.hpp"
#include "optimize/run/preview.hpp"
#include "score/exposure_plan.hpp"
#include "solid/voxel/wall.hpp"
#include "vam-plan/options.hpp"
#include "verdict/cavities.hpp"
#include "verdict/print_pieces.hpp"
#include "verdict/unresolved.hpp"

namespace vam::plan_tool {

inline constexpr int usual_coarseness = 4;  // pixels per voxel of the estimate
inline constexpr int most_estimated = 2;    // million voxels: those of larger parts are larger by a power of 2
inline constexpr double most_finer = 0.7;   // million voxels that are taken for thin walls and torn prints
inline constexpr const char* deviations = "axis=0.5px,index=0.005,angle=0.25deg";

/// Whether the part fits, and at which scale.
struct Fit {
  std::array<double, 3> size_mm{};
  double writable_radius_mm = 0;
  double writable_height_mm = 0;
  double factor = 1;  // largest scale that fits, relative to that of the options
  [[nodiscard]] bool fits() const { return factor >= 1; }
};

struct Plan {
  std::string subject;
  Fit now;
  std::optional<Fit> bath;            // with a bath of the resin's index; none: it has one
  double given_scale = 1;             // by the options
  double scale = 1;                   // of what follows, of the file's coordinates
  model::Grid grid;                   // at the printer's pixels
  double stretch_z = 1;               // of that grid
  std::optional<double> wall_voxels;  // of that grid; none: the thinnest one is thinner than the resolution
  double wall_mm = 0;                 // of the print
  std::optional<solid::Walls::Place> thinnest_place;  // or a neck, thinner than that
  verdict::Cavities cavities;                         // closed ones, in voxels of the walls' resolution
  bool in_doubt = false;         // the printer's voxels lose walls or gaps, or leave open whether they print
  bool sharp_edges = false;      // thinner than what prints
  int wall_resolution = 1;       // in voxels
  model::PartSurface surface;    // none known: no places, no solids
  int coarseness = 0;            // pixels per voxel of the estimate; 0: none is wanted
  verdict::Unresolved unjudged;  // walls and gaps too thin for the voxels of the estimate
  bool all_judged = true;        // they are hardly more than rounded edges
  double unjudged_low_mm = 0;    // heights in the print of most of them
  double unjudged_high_mm = 0;
  std::optional<optimize::Preview> preview;    // none: none of its voxels is wholly inside the part
  std::optional<verdict::PrintPieces> pieces;  // of part and print on its voxels
  bool resin_known = false;
  std::optional<score::ExposurePlan> exposure;  // none: the resin is not known, or gets no light
};

/// Throws Error: no_input, data.
[[nodiscard]] Plan plan(const Options& options, const model::Printer& printer);

[[nodiscard]] std::string table(const Plan& plan);
[[nodiscard]] Json report(const Plan& plan);

}  // namespace vam::plan_tool

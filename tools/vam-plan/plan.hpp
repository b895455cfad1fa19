// SPDX-License-Identifier: GPL-3.0-or-later
// The text and figures of a plan.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "base/text/json_fwd.hpp"
#include "model/grid.hpp"
#include "model/printer.hpp"
#include "solid/voxel/part.hpp"
#include "solid/voxel/wall.hpp"
#include "vam-plan/estimate.hpp"
#include "vam-plan/options.hpp"

namespace vam::plan_tool {

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
  model::Grid grid;                   // of the print
  double stretch_z = 1;               // of that grid
  std::optional<double> wall_voxels;  // of that grid; none: the thinnest one is thinner than the resolution
  double wall_mm = 0;                 // of the print
  std::optional<solid::Walls::Place> thinnest_place;  // or a neck, thinner than that
  verdict::Cavities cavities;                         // closed ones, in voxels of the walls' resolution
  verdict::SubVoxelFeatures
      unresolved;            // of the print's voxels; of many of them only what the part's own surface shows
  bool sharp_edges = false;  // thinner than what prints
  int wall_resolution = 1;   // in voxels
  [[nodiscard]] double thinnest_voxels() const {
    const double wall = wall_voxels.value_or(0);
    return thinnest_place ? std::min(wall, thinnest_place->voxels) : wall;
  }
  std::optional<Estimate> estimate;  // none is wanted
};

/// Throws Error: no_input, data.
[[nodiscard]] Plan plan(const Options& options, const model::Printer& printer);

/// Walls, gaps and cavities, on the print's voxels, or on larger ones where these are too many. Warns of what these do
/// not resolve.
void add_walls(Plan& plan, const solid::Part& part);

[[nodiscard]] std::string table(const Plan& plan);
[[nodiscard]] Json report(const Plan& plan);

}  // namespace vam::plan_tool

// A part that stands in the printer, whatever it came from, and how it becomes voxels slab by slab.
#pragma once

#include <functional>
#include <string>

#include "model/grid.hpp"
#include "solid/placement.hpp"
#include "solid/voxelize.hpp"

namespace vam::solid {

/// A placed part: where it is, and how to cover a grid with it.
struct Part {
  std::string subject;  // begins messages: the file's name, or "--shape gyroid"
  Extent extent;
  std::function<void(const model::Grid&, const SliceSink&)> fill;
};

/// The part of a shape under a placement.
[[nodiscard]] Part shape_part(const std::string& text, const Placement& placement, const Writable& room);

/// What a filled grid holds.
struct Content {
  double volume_mm3 = 0;    // in the target's frame, stretched along z
  long solid_voxels = 0;    // coverage 1
  long surface_voxels = 0;  // coverage between 0 and 1
  double radius_mm = 0;     // of the outermost voxel centre with coverage of at least 1/2
};

/// Fills the grid and hands each slab on. Throws Fault::data when nothing is covered.
Content fill(const Part& part, const model::Grid& grid, const SliceSink& sink);

}  // namespace vam::solid

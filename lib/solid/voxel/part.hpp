// SPDX-License-Identifier: GPL-3.0-or-later
// A part that stands in the printer, whatever it came from, and how it becomes voxels slab by slab.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/image.hpp"
#include "base/text/json_fwd.hpp"
#include "model/grid.hpp"
#include "model/mesh.hpp"
#include "model/part_surface.hpp"
#include "solid/mesh/repair.hpp"
#include "solid/voxel/placement.hpp"
#include "solid/voxel/voxelize.hpp"
#include "verdict/cavities.hpp"
#include "verdict/sub_voxel_features.hpp"

namespace vam::solid {

/// A placed part: where it is, and how to cover a grid with it.
struct Part {
  std::string subject;  // begins messages: the file's name, or "shape gyroid"
  PlacedExtent extent;
  Affine map;                    // from the file's coordinates to the target's frame
  std::optional<Repair> repair;  // of a mesh
  bool voted = false;            // inside is found by vote
  Lattice lattice;
  std::function<Vote(const model::Grid&, const SliceSink&)> fill;
  std::function<model::PartSurface(const model::Grid&)> surface;  // empty: the part has no surface of its own
};

/// The part of a shape (see make_shape) under a placement.
[[nodiscard]] Part shape_part(const std::string& text, const Placement& placement, const Writable& room);

/// Says what of its mesh was repaired, and what could not be.
void warn_of_repairs(const Part& part);

/// The part moved up along z.
[[nodiscard]] Part lifted(Part part, double lift_mm);

enum class FillMode { automatic, exact, vote };

/// The part of a mesh: moved by `map`, then repaired. Automatic fills exactly where the mesh is closed and votes where
/// it is not. Throws Fault::data when `exact` is requested of an open mesh; filling throws Fault::data when inside is
/// ambiguous: no volume is enclosed by a part of at least 4 voxels, or more than 1 % of it stays undecided.
[[nodiscard]] Part mesh_part(model::TriangleSoup mesh, const std::string& subject, const Affine& map, FillMode mode);

/// Numbered images, from the lowest slice up; row 0 of an image is at the largest y.
struct ImageStack {
  int width = 0;
  int height = 0;
  int count = 0;
  std::function<Image(int)> read;  // coverage 0...1; called in ascending order, twice
};

/// The part of a stack of images whose pixels and distances are voxel_mm: images centred on the axis, the stack on
/// z = 0. Stretching along z takes the mean of the images in a slice by their shares; x and y stay as they are (where
/// height is odd and width is not, or the reverse, y is off by half a voxel).
[[nodiscard]] Part image_part(ImageStack stack, const std::string& subject, double voxel_mm, double stretch_z);

/// What a filled grid holds.
struct FillSummary {
  double volume_mm3 = 0;    // in the target's frame, stretched along z
  long solid_voxels = 0;    // wholly covered, but for rounding [model::label_of]
  long surface_voxels = 0;  // partly
  float most = 0;           // the largest coverage
  double radius_mm = 0;     // from the axis to the centre of the farthest covered voxel, rounding left aside
  verdict::SubVoxelFeatures unresolved;
  verdict::Cavities cavities;
  Vote vote;
};

/// Fills the grid and hands each slab on. Throws Fault::data when nothing is covered.
FillSummary fill(const Part& part, const model::Grid& grid, const SliceSink& sink);

/// Contents of --report: volume and size of the print (not of the stretched target), the grid, repairs.
[[nodiscard]] Json figures(const Part& part, const FillSummary& content, const model::Grid& grid, double stretch_z,
                           const Writable& room);

}  // namespace vam::solid

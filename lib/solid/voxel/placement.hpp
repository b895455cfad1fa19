// SPDX-License-Identifier: GPL-3.0-or-later
// Where a part stands in the printer: its size, its turn, its place on the axis, and the voxels around it.
#pragma once

#include <optional>
#include <string>

#include "model/grid.hpp"
#include "model/mesh.hpp"
#include "model/printer.hpp"
#include "solid/shapes/field.hpp"

namespace vam::solid {

/// What the user asks for. Order: axes, scale, rotate, fit, centre, shift, stretch.
struct Placement {
  Affine axes;                   // which axis of the file points up, and whether one is mirrored
  double scale = 1;              // millimetres per unit of the file, and any factor on top
  Point rotate_deg{};            // about x, then y, then z, fixed axes
  std::optional<double> fit_mm;  // largest dimension
  bool fit_writable = false;     // as large as the writable cylinder allows; needs `centre`
  double voxel_mm = 0;           // fit_writable keeps the centres of all voxels that the surface cuts lit
  bool centre = true;            // middle of the bounding box to the origin
  Point at_mm{};                 // where the origin goes then
  double stretch_z = 1;          // [OST22 eq S5]: 1 / M_vp undoes the projector's vertical magnification
};

/// The quarter turns that bring an axis of the file, "x", "-x", ... "-z", to z.
[[nodiscard]] Affine upright(const std::string& axis);
/// Negates the coordinate "x", "y" or "z".
[[nodiscard]] Affine mirrored(const std::string& axis);

/// The cylinder about the rotation axis in which a part may be, z = 0 at the projector's axis_row.
struct Writable {
  double radius_mm = 0;
  double low_mm = 0;  // z, in the stretched frame of the focal plane
  double high_mm = 0;
  bool from_all_sides = true;  // lit so up to the radius; else it is the resin's
};
/// As high as no part is.
inline constexpr double any_height_mm = 1e6;

/// Of that radius (optics::writable_radius_mm), as high as the projector's rows.
[[nodiscard]] Writable writable(const model::Printer& printer, double radius_mm);

/// All of the resin, as high as the projector's rows.
[[nodiscard]] Writable whole_resin(const model::Printer& printer);

/// Extent of a placed part.
struct PlacedExtent {
  Bounds box;
  double radius_mm = 0;  // about the z axis
};
[[nodiscard]] PlacedExtent extent(const model::TriangleSoup& soup, const Affine& map = {});
[[nodiscard]] PlacedExtent extent(const Field& field);

/// The factor that makes a placed part fit the cylinder when it is scaled about the origin and lifted by whole voxels
/// into the rows: its surface, and the centres of the voxels that its surface cuts. 1 or more: it fits; 0 or less: no
/// factor will do.
[[nodiscard]] double fitting_factor(const PlacedExtent& part, const Writable& room, double voxel_mm);

/// The largest number of three digits that is not above a positive value: a scale that is typed so fits.
[[nodiscard]] double three_digits(double value);

/// The map from the file's coordinates to the target's frame. Throws Fault::data when the part has no size, or when
/// voxels are too large for fit_writable.
[[nodiscard]] Affine place(const model::TriangleSoup& soup, const Placement& placement, const Writable& room,
                           const std::string& subject);
[[nodiscard]] Affine place(const Field& field, const Placement& placement, const Writable& room,
                           const std::string& subject);

/// All points moved; triangles turned over when the map mirrors.
void transform(model::TriangleSoup& soup, const Affine& map);

/// Bodies in turn at the places of an array along x, y and z, in cells of the largest of them and `gap` between; as
/// many places as there are bodies, in the rows of the smallest radius, where `counts` are none.
[[nodiscard]] model::TriangleSoup in_rows(const std::vector<model::TriangleSoup>& bodies,
                                          std::optional<std::array<int, 3>> counts, double gap);

/// How the lattice of voxels lies: by default their faces are at multiples of voxel_mm in x, y and z. Stacks of images
/// bring a lattice of their own.
struct Lattice {
  bool odd_side = false;  // a voxel's centre on the axis, not a corner
  double z_phase = 0;     // faces at multiples plus this share of a voxel
};

/// Slices begin where a row of the projector does: with voxels of one or several pixels they coincide with rows.
[[nodiscard]] Lattice row_lattice(const model::Projector& projector, double voxel_mm);

/// The smallest grid around the axis that holds the part with one voxel to spare in x and y, and at least `radius_mm`
/// in every direction; nx = ny. Throws Fault::data above 4096 voxels a side, or 65536 slices.
[[nodiscard]] model::Grid grid_around(const PlacedExtent& part, double voxel_mm, double radius_mm,
                                      const Lattice& lattice, const std::string& subject);

/// What a caller can offer for a part that does not fit, in its own words, for the end of messages.
struct PlacementAdvice {
  std::string size = "scale";                // what sets the size of the part
  double value = 1;                          // its value in force
  double stretch_z = 1;                      // of the part, undone in the size that is reported
  std::string or_fit;                        // " or ...": what else fits it
  std::string unit;                          // "...; ": for a file in another unit
  std::string off_axis;                      // "...; ": for a part beside the axis
  std::string beyond;                        // ", ... allows it": beyond the writable radius
  std::string too_high = "move it along z";  // for a part that fits at another height
  std::string too_tall;                      // ", ... allows it": for a part taller than the image
};

/// Throws Fault::data, with both numbers, also in voxels, and the size that makes it fit, when the part leaves the
/// writable cylinder.
void require_writable(const PlacedExtent& part, const Writable& room, double voxel_mm, const std::string& subject,
                      const PlacementAdvice& advice = {});

/// The same for the centre of the farthest voxel that the part covers: what vam-optimize looks at.
void require_lit(double farthest_mm, const Writable& room, double voxel_mm, const std::string& subject,
                 const PlacementAdvice& advice = {});

/// Throws Fault::data when an insert is wider than the vial.
void require_within(const PlacedExtent& insert, double vial_radius_mm, const std::string& subject);

}  // namespace vam::solid

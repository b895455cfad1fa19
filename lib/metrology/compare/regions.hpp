// SPDX-License-Identifier: GPL-3.0-or-later
// Faces, bores and walls of a part: what of a print belongs to them, and their tolerances [physics §8].
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/text/json_fwd.hpp"
#include "metrology/compare/deviation.hpp"
#include "metrology/compare/fits.hpp"
#include "solid/mesh/geometry.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "solid/mesh/surface_samples.hpp"

namespace vam::metrology {

/// Geometry that is measured in a region, beside its deviation.
enum class RegionKind { surface, plane, cylinder, wall };

/// The design's surface within a box or on some faces, in the design's coordinates.
struct Region {
  std::string name;
  RegionKind kind = RegionKind::surface;
  solid::Bounds box{};
  std::string faces_file = {};                       // empty: the box
  std::shared_ptr<const solid::Surface> faces = {};  // of faces_file
  std::optional<double> tolerance_mm = {};           // of the figure `within`
};

/// "top=plane:-5,-5,4.9,5,5,5.1" or "seat=cylinder:seat.stl": name, kind, and two opposite corners in mm or the name of
/// a mesh, which is not read; without "plane:" a surface. Throws Fault::usage.
[[nodiscard]] Region parse_region(const std::string& text);

/// Names of figures for conditions on a region of that kind, after its name and a dot.
[[nodiscard]] std::vector<std::string> region_figures(RegionKind kind);

/// The points of both surfaces that belong to a region.
struct RegionPoints {
  Region region;
  // Of Distances::on_print: the nearest point of the design lies in the region, and faces alike within 60 degrees.
  std::vector<std::size_t> print;
  std::vector<std::size_t> design;             // of Distances::on_design; of a wall those that have an opposite side
  std::vector<Vector3> print_normals;          // of the design there
  PlaneFit plane;                              // of the design
  CylinderFit cylinder;                        // of the design
  std::vector<solid::SurfaceSample> opposite;  // of a wall, for each point of `design`
  std::vector<double> opposite_mm;             // distances there, positive: print outside the design
};

/// A plane is the part of the region's surface that faces within 10 degrees of its mean direction; a cylinder that
/// which is within 10 degrees of perpendicular to its axis; a wall has its other side in the region, facing the other
/// way. On faces is what is within 0.5 % of the design's largest dimension of them and faces alike within 60 degrees.
/// `feet`: nearest points of the design for on_print. Throws Fault::data when less than 100 points of either surface
/// belong to it.
[[nodiscard]] RegionPoints find_region(const Region& region, const Distances& distances,
                                       std::span<const solid::ClosestPoint> feet, const solid::Surface& design,
                                       const solid::Surface& print);

/// A disturbance of the print's distances: of on_print, of on_design and of the opposite sides of a region's wall.
struct RegionErrors {
  std::span<const double> print_mm;
  std::span<const double> design_mm;
  std::span<const double> opposite_mm;
};

/// The figures of a region, as in the report. Of a wall the thickness is the design's, by the largest ball that fits,
/// plus the distances on both sides.
[[nodiscard]] Json region_json(const RegionPoints& points, const Distances& distances,
                               const std::optional<RegionErrors>& errors);

/// The plane of a print's face.
[[nodiscard]] PlaneFit print_plane(const RegionPoints& points, const Distances& distances);

}  // namespace vam::metrology

// SPDX-License-Identifier: GPL-3.0-or-later
// Where the sections of a volume are, and their axes.
#include <cmath>

#include "base/error.hpp"
#include "plot/private/view_parts.hpp"

namespace vam::plot::views {

namespace {

const char* plane_name(Plane plane) {
  return plane == Plane::axial ? "axial" : plane == Plane::coronal ? "coronal" : "sagittal";
}

/// mm of the volume per mm in the print, across the plane.
double stretch_across(const ViewOptions& options) { return options.plane == Plane::axial ? options.stretch_z : 1; }

}  // namespace

Sections sections_of(const model::Grid& grid, const ViewOptions& options) {
  const Plane plane = options.plane;
  Sections found{spread(plane_count(grid, plane), options.sheet), {}, {}};
  const double stretch = stretch_across(options);
  const auto place_mm = [&](int index) { return plane_mm(grid, plane, index) / stretch; };
  if (options.at) found.indices = {plane_index(grid, plane, *options.at * stretch)};
  for (const int index : found.indices) {
    found.places_mm.push_back(plane_mm(grid, plane, index));
    found.captions.push_back(std::string(plane_axes(plane).across) + " = " + mm(place_mm(index)));
  }
  if (options.at && std::abs(found.places_mm[0] - *options.at * stretch) > 0.51 * grid.voxel_mm) {
    throw Error{Fault::data, options.name + ": has no " + plane_name(plane) + " section at " + mm(*options.at) +
                                 "; it reaches from " + mm(place_mm(0)) + " to " +
                                 mm(place_mm(plane_count(grid, plane) - 1))};
  }
  return found;
}

void set_section_axes(ImageFigure& figure, const model::Grid& grid, const ViewOptions& options) {
  const PlaneAxes axes = plane_axes(options.plane);
  const Spot first = plane_origin_mm(grid, options.plane);
  const Image& shape = figure.panels.front().values;
  const double half = 0.5 * grid.voxel_mm;
  const double stretch = options.plane == Plane::axial ? 1 : options.stretch_z;
  figure.x = {std::string(axes.right) + " (mm)", first.x - half, first.x - half + shape.width * grid.voxel_mm, false};
  figure.y = {std::string(axes.up) + " (mm)", (first.y - half) / stretch,
              (first.y - half + shape.height * grid.voxel_mm) / stretch, false};
  figure.size = options.size;
}

void add_outlines(ImageFigure& figure, const io::SparseVolume& target, const model::Grid& grid, Plane plane,
                  const Sections& sections) {
  const auto lines = outlines(target, grid, plane, sections.places_mm);
  for (std::size_t n = 0; n < lines.size(); ++n) figure.panels[n].outline = lines[n];
  figure.outline_name = "surface of the target";
}

std::string sections_text(const Sections& sections, Plane plane) {
  const std::string name = std::string(", ") + plane_name(plane);
  return sections.captions.size() == 1 ? name + " section at " + sections.captions[0] : name + " sections";
}

}  // namespace vam::plot::views

// SPDX-License-Identifier: GPL-3.0-or-later
// Where the sections of a volume are, and their axes.
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "io/vdb/vdb.hpp"
#include "model/dose/dose_metrics.hpp"
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
  const std::size_t each = figure.panels.size() / lines.size();
  for (std::size_t n = 0; n < figure.panels.size(); ++n) figure.panels[n].outline = lines[n / each];
  figure.outline_name = "surface of the target";
}

void crop(ImageFigure& figure, const PixelRect& part) {
  const Image shape = figure.panels.front().values;
  const auto kept = [&](const auto& image) {
    if (image.values.empty()) return image;
    std::remove_cvref_t<decltype(image)> some(part.width, part.height);
    for (int y = 0; y < part.height; ++y)
      for (int x = 0; x < part.width; ++x) some(x, y) = image(part.left + x, part.top + y);
    return some;
  };
  const auto is_in = [&](const Spot& spot) {
    return spot.x >= part.left - 0.5 && spot.x <= part.left + part.width - 0.5 && spot.y >= part.top - 0.5 &&
           spot.y <= part.top + part.height - 0.5;
  };
  for (Panel& panel : figure.panels) {
    panel.values = kept(panel.values);
    panel.hatched = kept(panel.hatched);
    panel.shaded = kept(panel.shaded);
    panel.picture = kept(panel.picture);
    std::erase_if(panel.outline, [&](const ContourPiece& piece) { return !is_in(piece.from) || !is_in(piece.to); });
    for (ContourPiece& piece : panel.outline) {
      for (Spot* spot : {&piece.from, &piece.to}) *spot = {spot->x - part.left, spot->y - part.top};
    }
  }
  const auto narrow = [](Axis& axis, int count, int below, int rest) {
    const double pitch = (axis.high - axis.low) / count;
    axis.high = axis.low + pitch * (below + rest);
    axis.low += pitch * below;
  };
  narrow(figure.x, shape.width, part.left, part.width);
  narrow(figure.y, shape.height, shape.height - part.top - part.height, part.height);
}

std::string sections_text(const Sections& sections, Plane plane) {
  const std::string name = std::string(", ") + plane_name(plane);
  return sections.captions.size() == 1 ? name + " section at " + sections.captions[0] : name + " sections";
}

}  // namespace vam::plot::views

namespace vam::plot {

void crop_to_part(ImageFigure& figure, const io::SparseVolume& target, Plane plane) {
  const model::VoxelBox box = io::covered_box(target, model::coverage_rounding);
  const std::size_t right = plane == Plane::sagittal ? 1 : 0, up = plane == Plane::axial ? 1 : 2;
  const Image& shape = figure.panels.front().values;
  const int margin = 2 + std::max(box.high[right] - box.low[right], box.high[up] - box.low[up]) / 20;
  const int left = std::max(0, box.low[right] - margin);
  const int top = std::max(0, shape.height - 1 - box.high[up] - margin);
  views::crop(figure, {left, top, std::min(shape.width, box.high[right] + margin + 1) - left,
                       std::min(shape.height, shape.height - box.low[up] + margin) - top});
}

}  // namespace vam::plot

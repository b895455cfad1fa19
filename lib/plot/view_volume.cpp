// Sections of a volume.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "plot/insert_sections.hpp"
#include "plot/private/view_parts.hpp"
#include "plot/view.hpp"

namespace vam::plot {

namespace {

using views::mm;

bool is_coverage(const std::string& grid) { return grid == "target" || grid == "insert" || grid == "weight"; }

const char* plane_name(Plane plane) {
  return plane == Plane::axial ? "axial" : plane == Plane::coronal ? "coronal" : "sagittal";
}

}  // namespace

ImageFigure view_volume(const io::SparseVolume& volume, const io::SparseVolume* target, const ViewOptions& options,
                        io::SparseVolume* insert) {
  const model::Grid& grid = volume.grid();
  const int count = plane_count(grid, options.plane);
  std::vector<int> indices = views::spread(count, options.sheet);
  if (options.at) indices = {plane_index(grid, options.plane, *options.at)};
  std::vector<double> places;
  for (const int index : indices) places.push_back(plane_mm(grid, options.plane, index));
  if (options.at && std::abs(places[0] - *options.at) > 0.51 * grid.voxel_mm) {
    throw Error{Fault::data, options.name + ": has no " + plane_name(options.plane) + " section at " + mm(*options.at) +
                                 "; it reaches from " + mm(plane_mm(grid, options.plane, 0)) + " to " +
                                 mm(plane_mm(grid, options.plane, count - 1))};
  }
  const PlaneAxes axes = plane_axes(options.plane);
  std::vector<Image> sections = planes(volume, options.plane, indices);
  ImageFigure figure;
  views::Extremes found;
  for (std::size_t n = 0; n < sections.size(); ++n) {
    found.add(sections[n]);
    figure.panels.push_back({std::move(sections[n]), std::string(axes.across) + " = " + mm(places[n]), {}});
  }
  if (target != nullptr) {
    const auto lines = outlines(*target, grid, options.plane, places);
    for (std::size_t n = 0; n < lines.size(); ++n) figure.panels[n].outline = lines[n];
    figure.outline_name = "surface of the target";
  }
  if (insert != nullptr) {
    insert->extend_to(grid);
    std::vector<InsertSection> hidden = insert_sections(*insert, options.plane, indices);
    for (std::size_t n = 0; n < hidden.size(); ++n) {
      figure.panels[n].hatched = std::move(hidden[n].coverage);
      figure.panels[n].shaded = std::move(hidden[n].shadow);
    }
    figure.hatched_name = "insert; orange: its shadow, the fuller the more angles are hidden";
  }
  if (is_coverage(volume.name())) found.high = std::max(found.high, 1.0);
  views::choose_colours(figure, options, found, is_coverage(volume.name()));
  const Spot first = plane_origin_mm(grid, options.plane);
  const Image& shape = figure.panels.front().values;
  const double half = 0.5 * grid.voxel_mm;
  figure.x = {std::string(axes.right) + " (mm)", first.x - half, first.x - half + shape.width * grid.voxel_mm, false};
  figure.y = {std::string(axes.up) + " (mm)", first.y - half, first.y - half + shape.height * grid.voxel_mm, false};
  figure.value_label = is_coverage(volume.name()) ? volume.name() + " (covered fraction)"
                                                  : views::with_unit(volume.name(), volume.units);
  figure.pixel_mm = grid.voxel_mm;
  figure.size = options.size;
  figure.title = options.name + ": " + volume.name() + ", " + plane_name(options.plane);
  figure.title += figure.panels.size() == 1
                      ? " section at " + figure.panels[0].caption
                      : " sections, " + std::string(axes.right) + " to the right, " + axes.up + " up";
  return figure;
}

}  // namespace vam::plot

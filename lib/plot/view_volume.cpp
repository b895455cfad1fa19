// Sections of a volume.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "plot/private/insert_sections.hpp"
#include "plot/private/view_parts.hpp"
#include "plot/view.hpp"

namespace vam::plot {

namespace {

using views::mm;

bool is_coverage(const std::string& grid) { return grid == "target" || grid == "insert" || grid == "weight"; }

const char* plane_name(Plane plane) {
  return plane == Plane::axial ? "axial" : plane == Plane::coronal ? "coronal" : "sagittal";
}

/// Where the sections are, in mm. Throws Fault::data where the volume has none there.
std::vector<double> places_of(const model::Grid& grid, const ViewOptions& options, const std::vector<int>& indices) {
  std::vector<double> places;
  for (const int index : indices) places.push_back(plane_mm(grid, options.plane, index));
  if (options.at && std::abs(places[0] - *options.at) > 0.51 * grid.voxel_mm) {
    throw Error{Fault::data, options.name + ": has no " + plane_name(options.plane) + " section at " + mm(*options.at) +
                                 "; it reaches from " + mm(plane_mm(grid, options.plane, 0)) + " to " +
                                 mm(plane_mm(grid, options.plane, plane_count(grid, options.plane) - 1))};
  }
  return places;
}

void add_outlines(ImageFigure& figure, const io::SparseVolume& target, const model::Grid& grid, Plane plane,
                  const std::vector<double>& places) {
  const auto lines = outlines(target, grid, plane, places);
  for (std::size_t n = 0; n < lines.size(); ++n) figure.panels[n].outline = lines[n];
  figure.outline_name = "surface of the target";
}

void add_insert(ImageFigure& figure, io::SparseVolume& insert, const model::Grid& grid, Plane plane,
                const std::vector<int>& indices) {
  insert.extend_to(grid);
  std::vector<InsertSection> hidden = insert_sections(insert, plane, indices);
  for (std::size_t n = 0; n < hidden.size(); ++n) {
    figure.panels[n].hatched = std::move(hidden[n].coverage);
    figure.panels[n].shaded = std::move(hidden[n].shadow);
  }
  figure.hatched_name = "insert; orange: its shadow, by the fraction of stage angles";
}

/// Axes, labels and title, once the panels are there.
void label(ImageFigure& figure, const io::SparseVolume& volume, const ViewOptions& options) {
  const model::Grid& grid = volume.grid();
  const PlaneAxes axes = plane_axes(options.plane);
  const Spot first = plane_origin_mm(grid, options.plane);
  const Image& shape = figure.panels.front().values;
  const double half = 0.5 * grid.voxel_mm;
  figure.x = {std::string(axes.right) + " (mm)", first.x - half, first.x - half + shape.width * grid.voxel_mm, false};
  figure.y = {std::string(axes.up) + " (mm)", first.y - half, first.y - half + shape.height * grid.voxel_mm, false};
  figure.scale.label = is_coverage(volume.name()) ? volume.name() + " (covered fraction)"
                                                  : views::with_unit(volume.name(), volume.units);
  figure.size = options.size;
  const std::string seen = options.name + ": " + volume.name() + ", " + plane_name(options.plane);
  figure.title = options.title.value_or(
      seen + (figure.panels.size() == 1 ? " section at " + figure.panels[0].caption : " sections"));
}

}  // namespace

ImageFigure view_volume(const io::SparseVolume& volume, const io::SparseVolume* target, const ViewOptions& options,
                        io::SparseVolume* insert) {
  const model::Grid& grid = volume.grid();
  std::vector<int> indices = views::spread(plane_count(grid, options.plane), options.sheet);
  if (options.at) indices = {plane_index(grid, options.plane, *options.at)};
  const std::vector<double> places = places_of(grid, options, indices);
  const PlaneAxes axes = plane_axes(options.plane);
  std::vector<Image> sections = planes(volume, options.plane, indices);
  ImageFigure figure;
  views::Extremes found;
  for (std::size_t n = 0; n < sections.size(); ++n) {
    found.add(sections[n]);
    figure.panels.push_back({std::move(sections[n]), std::string(axes.across) + " = " + mm(places[n]), {}});
  }
  if (target != nullptr) add_outlines(figure, *target, grid, options.plane, places);
  if (insert != nullptr) add_insert(figure, *insert, grid, options.plane, indices);
  if (is_coverage(volume.name())) found.high = std::max(found.high, 1.0);
  views::choose_colours(figure, options, found, is_coverage(volume.name()));
  label(figure, volume, options);
  return figure;
}

}  // namespace vam::plot

#include "vam-view/bodies.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text.hpp"
#include "facts.hpp"
#include "io/mesh/file.hpp"
#include "plot/render.hpp"
#include "solid/mesh/surface.hpp"
#include "solid/voxel/isosurface.hpp"

namespace vam::view_tool {

namespace {

constexpr double air = 1.04;  // of the square around the body
constexpr Rgb right_colour{190, 190, 190};

model::TriangleSoup surface_of(const io::SparseVolume& volume, double level) {
  return solid::isosurface(
      volume.grid(), [&](int k, int count, float* out) { volume.read_slices(k, count, out); }, level);
}

/// The square that holds the bodies from every side.
struct Sight {
  Vector3 centre{};
  double side_mm = 0;
};

Sight sight_of(const std::vector<const plot::Body*>& bodies) {
  solid::Box box = solid::bounding_box(bodies.front()->mesh);
  for (const plot::Body* body : bodies) {
    const solid::Box other = solid::bounding_box(body->mesh);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], other.low[axis]);
      box.high[axis] = std::max(box.high[axis], other.high[axis]);
    }
  }
  const Vector3 centre = 0.5 * (box.low + box.high);
  return {centre, air * plot::side_mm(bodies, centre, {})};
}

void add_panel(plot::ImageFigure& figure, const std::vector<const plot::Body*>& bodies, const Sight& sight, int pixels,
               const std::string& caption) {
  plot::Panel panel{Image(pixels, pixels), caption, {}};
  panel.picture = plot::render(bodies, sight.centre, sight.side_mm, {}, pixels);
  figure.panels.push_back(std::move(panel));
}

void label(plot::ImageFigure& figure, const Sight& sight, const plot::ViewOptions& view, const std::string& what) {
  const double half = 0.5 * sight.side_mm;
  figure.x = {"across the line of sight (mm)", -half, half};
  figure.y = {"mm", -half, half};
  figure.size = view.size;
  figure.title = view.title.value_or(view.name + what);
}

std::string size_text(const solid::Box& box) {
  const Vector3 size = box.high - box.low;
  return format_number(size[0], 3) + " x " + format_number(size[1], 3) + " x " + format_number(size[2], 3) +
         " mm, z upwards, seen from 25° above";
}

plot::ImageFigure single(const plot::Body& body, const plot::ViewOptions& view, const std::string& what) {
  plot::ImageFigure figure;
  const Sight sight = sight_of({&body});
  add_panel(figure, {&body}, sight, view.size, "");
  label(figure, sight, view, what);
  figure.legend.push_back({plot::Mark::none, {}, size_text(solid::bounding_box(body.mesh))});
  return figure;
}

/// The triangles of a mesh whose points are all farther than this outside the other.
model::TriangleSoup beyond(const model::TriangleSoup& mesh, const std::vector<float>& distances_mm, double limit_mm) {
  model::TriangleSoup kept{mesh.points, {}};
  for (const auto& triangle : mesh.triangles) {
    if (std::all_of(triangle.begin(), triangle.end(),
                    [&](int corner) { return static_cast<double>(distances_mm[corner]) > limit_mm; }))
      kept.triangles.push_back(triangle);
  }
  return kept;
}

}  // namespace

plot::ImageFigure mesh_figure(const std::string& path, const plot::ViewOptions& view) {
  io::ColouredMesh read = io::read_coloured_mesh(path);
  const plot::Body body{std::move(read.mesh), std::move(read.colours)};
  return single(body, view, "");
}

plot::ImageFigure body_figure(const io::SparseVolume& volume, double level, const plot::ViewOptions& view) {
  plot::Body body{surface_of(volume, level), {}};
  if (body.mesh.triangles.empty()) {
    throw Error{Fault::data, view.name + ": grid '" + volume.name() + "' reaches " + format_number(level, 4) +
                                 " nowhere; choose another --threshold"};
  }
  tool::unstretch(body.mesh, volume.metadata);
  return single(body, view, ": " + volume.name() + " at " + format_number(level, 4) + " " + volume.units);
}

plot::ImageFigure print_figure(const io::SparseVolume& dose, const io::SparseVolume& target, double threshold,
                               const plot::ViewOptions& view) {
  plot::Body part{surface_of(target, 0.5), {}};
  plot::Body print{surface_of(dose, threshold), {}};
  if (part.mesh.triangles.empty()) throw Error{Fault::data, view.name + ": the target is empty"};
  if (print.mesh.triangles.empty()) {
    throw Error{Fault::data, view.name + ": nothing prints at a threshold of " + format_number(threshold, 4) + " " +
                                 dose.units + "; choose a lower --threshold"};
  }
  tool::unstretch(part.mesh, target.metadata);
  tool::unstretch(print.mesh, target.metadata);
  const double voxel_mm = target.grid().voxel_mm;
  const std::vector<float> away = solid::Surface(part.mesh).signed_distances(print.mesh.points);
  for (const float distance : away) {
    print.colours.push_back(static_cast<double>(distance) > voxel_mm ? plot::paint::vermilion : right_colour);
  }
  plot::Body missing{beyond(part.mesh, solid::Surface(print.mesh).signed_distances(part.mesh.points), voxel_mm), {}};
  missing.colours.assign(missing.mesh.points.size(), plot::paint::blue);
  plot::ImageFigure figure;
  figure.columns = 2;
  const Sight sight = sight_of({&part, &print});
  const int pixels = view.size * 7 / 10;
  add_panel(figure, {&part}, sight, pixels, "target");
  add_panel(figure, {&print, &missing}, sight, pixels, "print at " + format_number(threshold, 4) + " " + dose.units);
  label(figure, sight, view, ": target and print");
  const std::string by = ", by more than a voxel (" + format_number(voxel_mm, 3) + " mm)";
  figure.legend = {{plot::Mark::patch, plot::paint::vermilion, "false cure: outside the target" + by},
                   {plot::Mark::patch, plot::paint::blue, "missing: target outside the print" + by},
                   {plot::Mark::none, {}, "target " + size_text(solid::bounding_box(part.mesh))}};
  return figure;
}

}  // namespace vam::view_tool

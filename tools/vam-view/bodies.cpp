// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/text/printable.hpp"
#include "base/text/text.hpp"
#include "model/dose/dose_metrics.hpp"
#include "plot/missing.hpp"
#include "plot/render.hpp"
#include "session/surface.hpp"
#include "solid/mesh/geometry.hpp"
#include "solid/mesh/signed_distance.hpp"
#include "vam-view/figures.hpp"

namespace vam::view_tool {

namespace {
constexpr double air = 1.04;  // of the square around the body
constexpr Rgb insert_colour = plot::paint::green;
}  // namespace

plot::Body insert_body(const io::SparseVolume* insert, const io::SparseVolume& part) {
  if (insert == nullptr) return {};
  plot::Body body{session::fine_surface(*insert, model::half_surface, part.metadata), {}};
  body.colours.assign(body.mesh.points.size(), insert_colour);
  return body;
}

void name_insert(plot::ImageFigure& figure, const plot::Body& insert) {
  if (!insert.mesh.triangles.empty()) figure.legend.push_back({plot::Mark::patch, insert_colour, "insert"});
}

Sight sight_of(const std::vector<const plot::Body*>& bodies) {
  solid::Bounds box = solid::bounding_box(bodies.front()->mesh);
  for (const plot::Body* body : bodies) {
    if (!body->mesh.triangles.empty()) box.join(solid::bounding_box(body->mesh));
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

std::string size_text(const solid::Bounds& box) {
  const Vector3 size = box.high - box.low;
  return format_number(size[0], 3) + " x " + format_number(size[1], 3) + " x " + format_number(size[2], 3) +
         " mm, z upwards, seen from 25° above";
}

namespace {

constexpr Rgb right_colour{190, 190, 190};

plot::ImageFigure single(const plot::Body& body, const plot::ViewOptions& view, const std::string& what,
                         const plot::Body& insert = {}) {
  plot::ImageFigure figure;
  const Sight sight = sight_of({&body, &insert});
  add_panel(figure, {&body, &insert}, sight, view.size, "");
  label(figure, sight, view, what);
  figure.legend.push_back({plot::Mark::none, {}, size_text(solid::bounding_box(body.mesh))});
  name_insert(figure, insert);
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
  io::ColouredMesh read = session::read_solid(
      path, "a volume (VDB), a stack (EXR), a video (MKV, MP4), a folder of images, a trace of vam-optimize (.csv)");
  const plot::Body body{std::move(read.mesh), std::move(read.colours)};
  return single(body, view, "");
}

plot::ImageFigure body_figure(const io::SparseVolume& volume, double level, const plot::ViewOptions& view,
                              const io::SparseVolume* insert) {
  plot::Body body{session::fine_surface(volume, level, volume.metadata), {}};
  if (body.mesh.triangles.empty()) {
    throw Error{Fault::data, view.name + ": grid " + excerpt(volume.name()) + " reaches " + format_number(level, 4) +
                                 " nowhere; choose another --isovalue"};
  }
  return single(body, view, ": " + volume.name() + " at " + format_number(level, 4) + " " + volume.units,
                insert_body(insert, volume));
}

plot::ImageFigure print_figure(const io::SparseVolume& dose, const io::SparseVolume& target, double threshold,
                               const plot::ViewOptions& view, const io::SparseVolume* insert) {
  plot::Body part{session::fine_surface(target, model::half_surface, target.metadata), {}};
  plot::Body print{session::fine_surface(dose, threshold, target.metadata), {}};
  if (part.mesh.triangles.empty()) throw Error{Fault::data, view.name + ": the target is empty"};
  if (print.mesh.triangles.empty()) {
    throw Error{Fault::data, view.name + ": nothing prints at a threshold of " + format_number(threshold, 4) + " " +
                                 dose.units + "; choose a lower --isovalue"};
  }
  const double voxel_mm = target.grid().voxel_mm;
  const std::vector<float> away = solid::Surface(part.mesh).signed_distances(print.mesh.points);
  for (const float distance : away) {
    print.colours.push_back(static_cast<double>(distance) > voxel_mm ? plot::paint::vermilion : right_colour);
  }
  plot::Body missing{beyond(part.mesh, solid::Surface(print.mesh).signed_distances(part.mesh.points), voxel_mm), {}};
  missing.colours.assign(missing.mesh.points.size(), plot::paint::blue);
  plot::Body thin{session::fine_surface(plot::lost_wall_volume(target, nullptr, 0), 0.5, target.metadata), {}};
  plot::Body lost{session::fine_surface(plot::lost_wall_volume(target, &dose, threshold), 0.5, target.metadata), {}};
  lost.colours.assign(lost.mesh.points.size(), plot::paint::blue);
  const plot::Body held = insert_body(insert, target);
  plot::ImageFigure figure;
  figure.columns = 2;
  std::vector<const plot::Body*> wanted{&part, &held}, printed{&print, &missing, &held};
  if (!thin.mesh.triangles.empty()) wanted.push_back(&thin);
  if (!lost.mesh.triangles.empty()) printed.push_back(&lost);
  std::vector<const plot::Body*> all = wanted;
  all.push_back(&print);
  const Sight sight = sight_of(all);
  const int pixels = view.size * 7 / 10;
  add_panel(figure, wanted, sight, pixels, "target");
  add_panel(figure, printed, sight, pixels, "print at " + format_number(threshold, 4) + " " + dose.units);
  label(figure, sight, view, ": target and print");
  const std::string by = ", by more than a voxel (" + format_number(voxel_mm, 3) + " mm)";
  figure.legend = {{plot::Mark::patch, plot::paint::vermilion, "false cure: outside the target" + by},
                   {plot::Mark::patch, plot::paint::blue,
                    "missing: target outside the print" + by +
                        (lost.mesh.triangles.empty() ? "" : ", and walls thinner than half a voxel")},
                   {plot::Mark::none, {}, "target " + size_text(solid::bounding_box(part.mesh))}};
  name_insert(figure, held);
  return figure;
}

}  // namespace vam::view_tool

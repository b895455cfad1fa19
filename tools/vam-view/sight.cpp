// SPDX-License-Identifier: GPL-3.0-or-later
#include "vam-view/sight.hpp"

#include <utility>

#include "base/text/text.hpp"
#include "model/dose/dose_metrics.hpp"
#include "session/surface.hpp"

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

}  // namespace vam::view_tool

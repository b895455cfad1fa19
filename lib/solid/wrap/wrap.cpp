// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/wrap/wrap.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/compute/memory.hpp"
#include "base/error.hpp"
#include "base/index.hpp"
#include "base/text/text.hpp"
#include "solid/mesh/geometry.hpp"
#include "solid/mesh/repair.hpp"

namespace vam::solid {

namespace {

using Point3 = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point3>;

void require_size(const model::TriangleSoup& mesh, double alpha_mm, const std::string& subject) {
  constexpr double most = 2e6;
  constexpr double triangle_bytes = 2e3;
  const double per_alpha = 2.1 * area_of(mesh);
  const double triangles = per_alpha / (alpha_mm * alpha_mm);
  if (triangles > most) {
    throw Error{Fault::data, subject + ": its wrap of " + format_number(alpha_mm, 3) + " mm would have " +
                                 format_number(triangles / 1e6, 3) + " million triangles; up to " +
                                 format_number(most / 1e6) + " million are made, give --wrap " +
                                 format_number(1.1 * std::sqrt(per_alpha / most), 2) + ",OFFSET or more"};
  }
  require_memory(triangle_bytes * (triangles + static_cast<double>(mesh.triangles.size())), subject + ": its wrap",
                 "use a larger --wrap");
}

/// Behind what the soup has.
void append(const Surface& surface, model::TriangleSoup& soup) {
  const int first = count_of(soup.points);
  for (const auto vertex : vertices(surface)) {
    const Point3& p = surface.point(vertex);
    soup.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto face : faces(surface)) {
    const auto side = halfedge(face, surface);
    const auto corner = [&](const auto& at) { return first + static_cast<int>(source(at, surface)); };
    soup.triangles.push_back({corner(side), corner(next(side, surface)), corner(prev(side, surface))});
  }
}

std::vector<Point3> points_of(const model::TriangleSoup& mesh) {
  std::vector<Point3> points;
  for (const auto& [x, y, z] : mesh.points) points.emplace_back(x, y, z);
  return points;
}

model::TriangleSoup wrap_of(const model::TriangleSoup& mesh, const WrapSize& size) {
  Surface surface;
  CGAL::alpha_wrap_3(points_of(mesh), mesh.triangles, size.alpha_mm, size.offset_mm, surface);
  model::TriangleSoup soup;
  append(surface, soup);
  return soup;
}

}  // namespace

Wrap wrapped(const model::TriangleSoup& mesh, const WrapSize& size, const std::string& subject) {
  constexpr double both_sides = 1.2;  // times the area: the wrap lies on the inside of a body, too
  model::TriangleSoup lidded = mesh;
  Wrap made;
  made.open_edges = close_holes(lidded, 2 * size.alpha_mm);
  require_size(lidded, size.alpha_mm, subject);
  made.mesh = wrap_of(lidded, size);
  if (area_of(made.mesh) > both_sides * area_of(lidded)) {
    close_holes(lidded);
    made.mesh = wrap_of(lidded, size);
  }
  return made;
}

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

[[noreturn]] void not_cut(const std::string& subject, const std::string& why) {
  throw Error{Fault::data, subject + ": a volume is to be taken away from another, but " + why +
                               "; do it in the program that made the file, or leave the volume out"};
}

Surface surface_of(const model::TriangleSoup& mesh) {
  std::vector<Point3> points = points_of(mesh);
  std::vector<std::array<int, 3>> triangles = mesh.triangles;
  pmp::orient_polygon_soup(points, triangles);  // has bodies that share an edge or a corner each have its own
  Surface surface;
  pmp::polygon_soup_to_polygon_mesh(points, triangles, surface);
  return surface;
}

/// The whole mesh, or each of its connected bodies where these cross.
std::vector<Surface> bodies_of(model::TriangleSoup mesh, const std::string& subject) {
  const Repair done = repair(mesh, subject);
  if (!done.closed()) not_cut(subject, "one of them is not closed (" + done.summary() + ")");
  const Surface whole = surface_of(mesh);
  if (!pmp::does_self_intersect(whole)) return {whole};
  if (done.cavities > 0) not_cut(subject, "one of them has cavities and crosses itself");
  std::vector<Surface> bodies;
  pmp::split_connected_components(whole, bodies);
  for (const Surface& body : bodies)
    if (pmp::does_self_intersect(body)) not_cut(subject, "one of them crosses itself");
  return bodies;
}

}  // namespace

model::TriangleSoup difference(model::TriangleSoup mesh, model::TriangleSoup taken_away, const std::string& subject) {
  model::TriangleSoup left;
  std::vector<Surface> cutters = bodies_of(std::move(taken_away), subject);
  for (Surface& body : bodies_of(std::move(mesh), subject)) {
    for (Surface cutter : cutters) {
      Surface rest;
      if (!pmp::corefine_and_compute_difference(body, cutter, rest)) not_cut(subject, "they touch along an edge");
      body = std::move(rest);
    }
    body.collect_garbage();
    append(body, left);
  }
  if (left.triangles.empty()) not_cut(subject, "nothing is left of it");
  return left;
}

}  // namespace vam::solid

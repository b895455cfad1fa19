// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/polygon_soup.hpp"

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Simple_cartesian.h>

#include <array>
#include <vector>

namespace vam::oracle {

namespace soup = CGAL::Polygon_mesh_processing;

model::TriangleSoup oriented_by_cgal(const model::TriangleSoup& mesh) {
  using Point = CGAL::Simple_cartesian<double>::Point_3;
  std::vector<Point> points;
  for (const auto& p : mesh.points) points.emplace_back(p[0], p[1], p[2]);
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const auto& t : mesh.triangles) {
    triangles.push_back(
        {static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]), static_cast<std::size_t>(t[2])});
  }
  soup::merge_duplicate_points_in_polygon_soup(points, triangles);
  soup::merge_duplicate_polygons_in_polygon_soup(points, triangles);
  soup::orient_polygon_soup(points, triangles);
  model::TriangleSoup result;
  for (const Point& p : points) result.points.push_back({p.x(), p.y(), p.z()});
  for (const auto& t : triangles) {
    result.triangles.push_back({static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])});
  }
  return result;
}

}  // namespace vam::oracle

// SPDX-License-Identifier: GPL-3.0-or-later
#include "metrology/compare/surface_errors.hpp"

#include <algorithm>
#include <numbers>

#include "base/stats/median.hpp"

namespace vam::metrology {

namespace {

double edge_mm(const model::TriangleSoup& mesh, std::size_t triangle, std::size_t side) {
  const auto& t = mesh.triangles[triangle];
  return length(mesh.points[t[(side + 1) % 3]] - mesh.points[t[side]]);
}

}  // namespace

double mean_edge_mm(const model::TriangleSoup& mesh) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) sum += edge_mm(mesh, t, 0);
  return sum / static_cast<double>(mesh.triangles.size());
}

SurfaceErrors roughness(const model::TriangleSoup& print, const solid::Surface& design, double largest_dimension_mm) {
  constexpr std::size_t most = 20000;
  constexpr double longest = 0.02;
  const std::size_t step = std::max<std::size_t>(1, print.triangles.size() / most);
  std::vector<Vector3> ends;
  for (std::size_t t = 0; t < print.triangles.size(); t += step) {
    if (edge_mm(print, t, 0) > longest * largest_dimension_mm) continue;
    ends.push_back(print.points[print.triangles[t][0]]);
    ends.push_back(print.points[print.triangles[t][1]]);
  }
  const std::vector<float> distances = design.signed_distances(ends);
  std::vector<double> differences;
  for (std::size_t i = 0; i + 1 < distances.size(); i += 2) {
    differences.push_back(static_cast<double>(distances[i] - distances[i + 1]));
  }
  SurfaceErrors found{"roughness", {}, mean_edge_mm(print), 0, 0};
  const double sigma_mm = differences.empty() ? 0.0 : stats::robust_sigma(std::move(differences)) / std::numbers::sqrt2;
  found.vertex_mm.assign(print.points.size(), static_cast<float>(sigma_mm));
  return found;
}

}  // namespace vam::metrology

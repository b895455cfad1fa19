// SPDX-License-Identifier: GPL-3.0-or-later
#include "solid/mesh/geometry.hpp"

#include "base/constants.hpp"

namespace vam::solid {

Bounds bounding_box(const model::TriangleSoup& mesh) {
  Bounds box;
  for (const auto& triangle : mesh.triangles) {
    for (const int corner : triangle) box.add(mesh.points[corner]);
  }
  return box;
}

double area_of(const model::TriangleSoup& mesh) {
  double twice = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    twice += length(cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]));
  return 0.5 * twice;
}

Affine scaling(const Point& s) { return {{Point{s[0], 0, 0}, Point{0, s[1], 0}, Point{0, 0, s[2]}}, {}}; }

namespace {

// One turn by whole multiples of 90 degrees must not smear a face over two voxels: sine and cosine are then exact.
Affine turn(std::size_t axis, double angle_deg) {
  const double quarter = std::round(angle_deg / 90);
  double c = std::cos(angle_deg * rad_per_deg);
  double s = std::sin(angle_deg * rad_per_deg);
  if (angle_deg == 90 * quarter) {
    c = std::round(c);
    s = std::round(s);
  }
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  Affine result;
  result.linear[u][u] = c;
  result.linear[u][v] = -s;
  result.linear[v][u] = s;
  result.linear[v][v] = c;
  return result;
}

}  // namespace

Affine rotation(const Point& xyz_deg) { return turn(2, xyz_deg[2]) * (turn(1, xyz_deg[1]) * turn(0, xyz_deg[0])); }

Affine Affine::after(const Affine& b) const {
  Affine result;
  for (std::size_t r = 0; r < 3; ++r) {
    result.linear[r] = linear[r][0] * b.linear[0] + linear[r][1] * b.linear[1] + linear[r][2] * b.linear[2];
  }
  result.shift = (*this)(b.shift);
  return result;
}

Affine inverse(const Affine& a) {
  const auto& m = a.linear;
  // Rows of the adjugate are cross products of the columns.
  const Point c0{m[0][0], m[1][0], m[2][0]};
  const Point c1{m[0][1], m[1][1], m[2][1]};
  const Point c2{m[0][2], m[1][2], m[2][2]};
  const double determinant = dot(c0, cross(c1, c2));
  Affine result;
  result.linear = {(1 / determinant) * cross(c1, c2), (1 / determinant) * cross(c2, c0),
                   (1 / determinant) * cross(c0, c1)};
  const Point moved = Affine{result.linear, {}}(a.shift);
  result.shift = -1.0 * moved;
  return result;
}

}  // namespace vam::solid

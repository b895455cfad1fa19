// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numbers>

#include "solid/mesh/private/triangle_tree.hpp"

namespace vam::solid {

namespace {

constexpr double far = 2.0;  // a node is summarised beyond this many radii

Vector3 area_vector(const TriangleCorners& t) { return 0.5 * cross(t[1] - t[0], t[2] - t[0]); }

Vector3 centroid(const TriangleCorners& t) { return (1.0 / 3.0) * (t[0] + t[1] + t[2]); }

// Solid angles of the triangles seen from a point: tan(angle / 2) = numerator / denominator [OS83; physics §13.2].
// Small half angles are added by multiplying complex numbers, so that a leaf needs one arctangent.
double triangle_angles(const TriangleCorners* begin, const TriangleCorners* end, const Vector3& point) {
  constexpr double small = 0.75;  // atan(0.75) x 4 triangles stays below pi
  double re = 1;
  double im = 0;
  double half = 0;
  for (const TriangleCorners* t = begin; t != end; ++t) {
    const Vector3 a = (*t)[0] - point;
    const Vector3 b = (*t)[1] - point;
    const Vector3 c = (*t)[2] - point;
    const double la = length(a);
    const double lb = length(b);
    const double lc = length(c);
    const double numerator = dot(a, cross(b, c));
    const double denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    if (std::abs(numerator) < small * denominator) {
      const double turned = re * denominator - im * numerator;
      im = re * numerator + im * denominator;
      re = turned;
    } else {
      half += std::atan2(numerator, denominator);
    }
  }
  return 2 * (half + std::atan2(im, re));
}

double farthest_corner(const TriangleNode& node, const Vector3& from) {
  Vector3 way{};
  for (std::size_t d = 0; d < 3; ++d) way[d] = std::max(from[d] - node.box.low[d], node.box.high[d] - from[d]);
  return length(way);
}

}  // namespace

WindingNumber::WindingNumber(const model::TriangleSoup& mesh)
    : WindingNumber(std::make_shared<const TriangleTree>(corners_of(mesh))) {}

WindingNumber::WindingNumber(std::shared_ptr<const TriangleTree> tree) : tree_(std::move(tree)) {
  const auto& nodes = tree_->nodes;
  clusters_.resize(nodes.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {  // children come after their parent
    clusters_[i] = nodes[i].right == 0 ? of_leaf(nodes[i]) : merged(clusters_[i + 1], clusters_[nodes[i].right]);
    clusters_[i].reach = far * farthest_corner(nodes[i], clusters_[i].centre);
  }
}

WindingNumber::Cluster WindingNumber::of_leaf(const TriangleNode& node) const {
  const auto of_triangle = [&](int i) {
    const TriangleCorners& t = tree_->triangles[i];
    const Vector3 area = area_vector(t);
    return Cluster{.centre = centroid(t), .area = area, .weight = length(area)};
  };
  Cluster leaf = of_triangle(node.begin);
  for (int i = node.begin + 1; i < node.end; ++i) leaf = merged(leaf, of_triangle(i));
  return leaf;
}

WindingNumber::Cluster WindingNumber::merged(const Cluster& a, const Cluster& b) const {
  Cluster both;
  both.weight = a.weight + b.weight;
  both.area = a.area + b.area;
  both.centre = (1 / both.weight) * (a.weight * a.centre + b.weight * b.centre);
  for (std::size_t d = 0; d < 3; ++d) {
    both.second[d] =
        a.second[d] + b.second[d] + (a.centre[d] - both.centre[d]) * a.area + (b.centre[d] - both.centre[d]) * b.area;
  }
  return both;
}

// Omega = sum of A . grad G with G = -1/r: first order A.r/r^3, second order the derivative of that along the offsets
// [BAR18 eq 14, BAR18 eq 15].
double WindingNumber::solid_angle(std::size_t index, const Vector3& point) const {
  const Cluster& cluster = clusters_[index];
  const Vector3 r = cluster.centre - point;
  const double distance2 = dot(r, r);
  if (distance2 > cluster.reach * cluster.reach) {
    const double cubed = distance2 * std::sqrt(distance2);
    double trace = 0;
    double along = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      trace += cluster.second[d][d];
      along += r[d] * dot(cluster.second[d], r);
    }
    return (dot(cluster.area, r) + trace - 3 * along / distance2) / cubed;
  }
  const TriangleNode& node = tree_->nodes[index];
  if (node.right != 0) return solid_angle(index + 1, point) + solid_angle(node.right, point);
  return triangle_angles(tree_->triangles.data() + node.begin, tree_->triangles.data() + node.end, point);
}

double WindingNumber::operator()(const Vector3& point) const {
  return clusters_.empty() ? 0.0 : solid_angle(0, point) / (4 * std::numbers::pi);
}

}  // namespace vam::solid

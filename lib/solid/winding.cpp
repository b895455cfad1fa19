#include "solid/winding.hpp"

#include <algorithm>
#include <numbers>

namespace vam::solid {

namespace {

constexpr int leaf_size = 8;
constexpr double far =
    3.0;  // a node is summarised when the point is farther than this many radii: a disc then errs by 8 %

using Triangle = std::array<Vector3, 3>;

Vector3 area_vector(const Triangle& t) { return 0.5 * cross(t[1] - t[0], t[2] - t[0]); }

Vector3 centroid(const Triangle& t) { return (1.0 / 3.0) * (t[0] + t[1] + t[2]); }

// Solid angle of a triangle seen from the origin of a, b, c (Van Oosterom & Strackee 1983).
double triangle_angle(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double la = length(a);
  const double lb = length(b);
  const double lc = length(c);
  const double numerator = dot(a, cross(b, c));
  const double denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return 2 * std::atan2(numerator, denominator);
}

}  // namespace

WindingNumber::WindingNumber(const model::TriangleSoup& mesh) {
  triangles_.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    triangles_.push_back({mesh.points[static_cast<std::size_t>(t[0])], mesh.points[static_cast<std::size_t>(t[1])],
                          mesh.points[static_cast<std::size_t>(t[2])]});
  }
  nodes_.reserve(2 * triangles_.size() / leaf_size + 2);
  build(0, static_cast<int>(triangles_.size()), triangles_);
}

// Splits at the median of the longest side of the centroids' box; children follow their parent.
int WindingNumber::build(int begin, int end, std::vector<Triangle>& triangles) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.begin = begin;
  node.end = end;
  if (end - begin > leaf_size) {
    Vector3 low = centroid(triangles[static_cast<std::size_t>(begin)]);
    Vector3 high = low;
    for (int i = begin; i < end; ++i) {
      const Vector3 c = centroid(triangles[static_cast<std::size_t>(i)]);
      for (std::size_t d = 0; d < 3; ++d) {
        low[d] = std::min(low[d], c[d]);
        high[d] = std::max(high[d], c[d]);
      }
    }
    const Vector3 size = high - low;
    const auto axis = static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
    const int middle = (begin + end) / 2;
    std::nth_element(triangles.begin() + begin, triangles.begin() + middle, triangles.begin() + end,
                     [axis](const Triangle& a, const Triangle& b) { return centroid(a)[axis] < centroid(b)[axis]; });
    node.left = build(begin, middle, triangles);
    node.right = build(middle, end, triangles);
  }
  summarise(node);
  nodes_[static_cast<std::size_t>(index)] = node;
  return index;
}

void WindingNumber::summarise(Node& node) const {
  double total = 0;
  for (int i = node.begin; i < node.end; ++i) {
    const Triangle& t = triangles_[static_cast<std::size_t>(i)];
    const Vector3 a = area_vector(t);
    total += length(a);
    node.area = node.area + a;
    node.centre = node.centre + length(a) * centroid(t);
  }
  if (total > 0) node.centre = (1 / total) * node.centre;
  for (int i = node.begin; i < node.end; ++i) {
    const Triangle& t = triangles_[static_cast<std::size_t>(i)];
    const Vector3 a = area_vector(t);
    const Vector3 offset = centroid(t) - node.centre;
    for (std::size_t d = 0; d < 3; ++d) node.second[d] = node.second[d] + offset[d] * a;
    for (const Vector3& corner : t) node.radius = std::max(node.radius, length(corner - node.centre));
  }
}

// Omega = sum of A . grad G with G = -1/r: first order A.r/r^3, second order the derivative of that along the offsets
// [Barill18 eq 14 and 15].
double WindingNumber::solid_angle(int index, const Vector3& point) const {
  const Node& node = nodes_[static_cast<std::size_t>(index)];
  const Vector3 r = node.centre - point;
  const double distance = length(r);
  if (distance > far * node.radius) {
    const double cubed = distance * distance * distance;
    double angle = dot(node.area, r) / cubed;
    double trace = 0;
    double along = 0;
    for (std::size_t d = 0; d < 3; ++d) {
      trace += node.second[d][d];
      along += r[d] * dot(node.second[d], r);
    }
    angle += trace / cubed - 3 * along / (cubed * distance * distance);
    return angle;
  }
  if (node.left >= 0) return solid_angle(node.left, point) + solid_angle(node.right, point);
  double angle = 0;
  for (int i = node.begin; i < node.end; ++i) {
    const Triangle& t = triangles_[static_cast<std::size_t>(i)];
    angle += triangle_angle(t[0] - point, t[1] - point, t[2] - point);
  }
  return angle;
}

double WindingNumber::operator()(const Vector3& point) const { return solid_angle(0, point) / (4 * std::numbers::pi); }

}  // namespace vam::solid
